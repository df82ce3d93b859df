#pragma once

#include "../../VolumeGeometry.h"
#include "../../core/geometry/TetraCrossings.h"
#include "../../render/volume/PreparedGeometry.h"
#include "PickData.h"

#include <glm/vec4.hpp>

#include <memory>
#include <mutex>
#include <vector>

namespace osgVolumizer {
namespace picking {

/// A segment in the object frame. Its parameter runs from 0 at the start to 1 at the end.
struct Segment
{
    glm::dvec3 start{0.0}, end{0.0};

    glm::dvec3 direction() const { return end - start; }
    glm::dvec3 at(double parameter) const { return start + parameter * direction(); }
    double length() const;
    /// Finite, and longer than nothing.
    bool valid() const;
};

/// A part of a segment inside a volume's region, on which the voxel coordinate is affine.
struct Span
{
    double begin = 0.0, end = 1.0;         ///< parameters of the segment
    glm::dvec3 voxel{0.0}, voxelRate{0.0}; ///< voxel frame: at parameter 0, and its change
    glm::dvec4 color{1.0}, colorRate{0.0}; ///< of vertices, likewise; RGBA, straight
    double scalar = 0.0, scalarRate = 0.0; ///< of unstructured grids, likewise
    std::uint32_t tetrahedron = 0;         ///< where it is in one; see `inTetrahedron`
    bool inTetrahedron = false;

    glm::dvec3 voxelAt(double parameter) const { return voxel + parameter * voxelRate; }
    glm::dvec4 colorAt(double parameter) const { return color + parameter * colorRate; }
    double scalarAt(double parameter) const { return scalar + parameter * scalarRate; }
};

/// The region of a geometry that is seen with voxels or none. Immutable; thread safe.
class PickRegion
{
public:
    /// Expects that there are tetrahedra.
    PickRegion(std::shared_ptr<const render::PreparedGeometry> prepared, const Voxels* voxels,
               const VolumeGeometry::ScalarField& scalars);

    const render::PreparedGeometry& prepared() const { return *_prepared; }
    bool hasColors() const { return _prepared->tetras.vertices.format().colorSize > 0; }
    /// Object -> frame of the prepared geometry.
    glm::dvec3 toFrame(const glm::dvec3& object) const;
    /// The tetrahedra that a segment crosses.
    std::vector<core::TetraCrossings::Crossing> crossings(const Segment& segment) const;

    /// The parts of a segment inside the region and the voxels, in their order; they do not
    /// overlap.
    /// \param clipPlanes see PickOptions
    std::vector<Span> spans(const Segment& segment,
                            const std::vector<osg::Vec4d>& clipPlanes) const;
    /// The tetrahedron at a place of a segment.
    std::uint32_t tetrahedronAt(const Segment& segment, double parameter) const;

    /// Voxel coordinate (affine) of a tetrahedron's positions in the frame; false without volume,
    /// or voxels.
    bool voxelMap(std::size_t tetrahedron, glm::dmat4& map) const;
    /// Extent of the voxels, voxel frame; all of space without any.
    const core::Box3d& extent() const { return _extent; }

private:
    std::vector<Span> convexSpan(const glm::dvec3& start, const glm::dvec3& end, double begin,
                                 double finish) const;
    Span spanOf(const core::TetraCrossings::Crossing& crossing, const glm::dvec3& start,
                const glm::dvec3& end) const;
    void setScalars(const core::TetraCrossings::Crossing& crossing, Span& span) const;

    std::shared_ptr<const render::PreparedGeometry> _prepared;
    glm::dmat3 _toFrame;
    core::Box3d _extent;
    core::TetraCrossings _crossings;
    VolumeGeometry::ScalarsPtr _scalars; ///< null for none
    bool _ofCells;
};

/// The region, made once for each state of geometry and voxels; null where it is empty. `voxels`
/// may be null.
std::shared_ptr<const PickRegion> pickRegion(const VolumeGeometry& geometry, const Voxels* voxels);

} // namespace picking
} // namespace osgVolumizer
