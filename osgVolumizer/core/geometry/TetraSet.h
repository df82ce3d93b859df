#pragma once

#include "../Status.h"
#include "Box.h"
#include "VertexFormat.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Vertex records, stored one after another as doubles. Positions are in the object frame of their
/// owner, voxel coordinates in the voxel frame (sample (i,j,k) sits at integer coordinates).
class OSGVOLUMIZER_CORE_EXPORT VertexArray
{
public:
    VertexArray() = default;
    explicit VertexArray(const VertexFormat& format) : _format(format) {}

    const VertexFormat& format() const { return _format; }
    std::size_t size() const { return _values.size() / static_cast<std::size_t>(_format.stride()); }
    void resize(std::size_t n) { _values.resize(n * static_cast<std::size_t>(_format.stride())); }
    const double* record(std::size_t i) const { return _values.data() + i * stride(); }
    double* record(std::size_t i) { return _values.data() + i * stride(); }
    const std::vector<double>& values() const { return _values; }
    std::vector<double>& values() { return _values; }

    glm::dvec3 position(std::size_t i) const
    {
        const double* p = record(i) + _format.positionOffset();
        return {p[0], p[1], p[2]};
    }
    void setPosition(std::size_t i, const glm::dvec3& p)
    {
        double* r = record(i) + _format.positionOffset();
        r[0] = p.x, r[1] = p.y, r[2] = p.z;
    }
    /// Expects format().voxelCoordinateSize == 3.
    glm::dvec3 voxelCoordinate(std::size_t i) const
    {
        const double* p = record(i) + _format.voxelCoordinateOffset();
        return {p[0], p[1], p[2]};
    }
    /// Expects format().voxelCoordinateSize == 3.
    void setVoxelCoordinate(std::size_t i, const glm::dvec3& p)
    {
        double* r = record(i) + _format.voxelCoordinateOffset();
        r[0] = p.x, r[1] = p.y, r[2] = p.z;
    }

private:
    std::size_t stride() const { return static_cast<std::size_t>(_format.stride()); }

    VertexFormat _format;
    std::vector<double> _values;
};

/// Indexed tetrahedra over shared vertex records: four indices each, in any orientation.
class OSGVOLUMIZER_CORE_EXPORT TetraSet
{
public:
    using Index = std::uint32_t;
    /// Larger values are refused: faces are single precision, which ends at 3e38.
    static constexpr double MAX_MAGNITUDE = 1e30;

    VertexArray vertices;
    std::vector<Index> indices; ///< 4 per tetrahedron

    std::size_t tetraCount() const { return indices.size() / 4; }
    bool empty() const { return indices.empty(); }
    /// Bounds of the positions of all vertices that are referred to, in the object frame.
    Box3d bounds() const;
    /// Refuses NaN, infinite and absurd (MAX_MAGNITUDE) values, indices out of range, and a number
    /// of indices that is not a multiple of four; the status names the first offender. Degenerate
    /// and inverted tetrahedra are fine: the former have no volume, the latter count like any
    /// other.
    Status validate() const;
};

} // namespace core
} // namespace osgVolumizer
