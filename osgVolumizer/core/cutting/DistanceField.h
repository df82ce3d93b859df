#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "../voxels/VoxelData.h"
#include "TriangleMesh.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Signed distances to the surface of what is kept, positive inside, at the samples of a grid over
/// a box, and linear between them: so a smooth surface is met to second order in the distance of
/// the samples, and edges are rounded by about that distance. Several regions leave what all of
/// them keep: the smallest distance counts. In the frame and units of the box.
class OSGVOLUMIZER_CORE_EXPORT DistanceField
{
public:
    /// All is kept at first. Samples lie on the faces of the box.
    /// \param samples along each axis, 2 or more
    /// \param reach distances beyond it are only known to be at least that
    DistanceField(const Box3d& box, const glm::ivec3& samples, double reach);

    /// Keeps the inside, or the outside, of a closed mesh (see checkClosed()): which side a sample
    /// is on is how often the line to it crosses the mesh.
    void cutBySurface(const TriangleMesh& mesh, bool keepInside);
    /// Keeps where a function is positive; NaN counts as negative. Its zeros are met where it is
    /// linear between samples. It is scaled so that it grows no faster than the distance to them.
    /// \param distances takes distances to its zeros on the edges of the grid's cells instead, good
    /// to half a cell
    void cutByFunction(const std::function<double(const glm::dvec3&)>& function, bool distances);
    /// Keeps where a signed distance is positive.
    void cutByDistance(const std::function<double(const glm::dvec3&)>& distance);

    const Box3d& box() const { return _box; }
    const glm::ivec3& samples() const { return _samples; }
    /// Edges of a cell.
    glm::dvec3 spacing() const { return _box.size() / glm::dvec3(_samples - 1); }
    /// At the samples, x fastest.
    const std::vector<float>& values() const { return _values; }
    /// At any place; outside the box as at its faces.
    double at(const glm::dvec3& place) const;
    /// Lowest and highest of the values within a box, or a little more.
    ValueRange rangeIn(const Box3d& box) const;

private:
    glm::dvec3 sampleAt(const glm::ivec3& i) const { return _box.min + glm::dvec3(i) * spacing(); }
    std::size_t index(const glm::ivec3& i) const
    {
        return std::size_t(i.x) +
               std::size_t(_samples.x) *
                   (std::size_t(i.y) + std::size_t(_samples.y) * std::size_t(i.z));
    }
    /// The grid coordinates of a place, held within the grid.
    glm::dvec3 gridPlace(const glm::dvec3& place) const;
    template <class F>
    void forSamples(const Box3i& part, F&& f) const;
    void keepLess(const std::vector<float>& values);
    void findBlocks();
    std::vector<std::uint8_t> insideOf(const TriangleMesh& mesh) const;
    std::vector<float> distancesTo(const TriangleMesh& mesh) const;
    std::vector<float> scaledToDistances(const std::vector<double>& values) const;
    TriangleMesh zerosOf(const std::vector<double>& values) const;

    Box3d _box;
    glm::ivec3 _samples;
    double _reach;
    std::vector<float> _values;
    glm::ivec3 _blockCount{0};
    std::vector<ValueRange> _blocks; ///< of values in blocks of cells
};

} // namespace core
} // namespace osgVolumizer
