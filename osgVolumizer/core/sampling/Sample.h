#pragma once

#include "../Export.h"
#include "../Status.h"
#include "../geometry/Box.h"
#include "../geometry/TetraSet.h"
#include "SurfaceFamily.h"

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

class RecordPolygon;

/// Convex polygons of full vertex records in double precision, one after another, sharing nothing:
/// what sample() makes and clip() changes.
struct OSGVOLUMIZER_CORE_EXPORT PolygonSet
{
    VertexFormat format;
    std::vector<double> values;                ///< records of `format`
    std::vector<std::uint32_t> faceOffsets{0}; ///< face f is records [faceOffsets[f], [f + 1])

    std::size_t faceCount() const { return faceOffsets.size() - 1; }
    std::size_t size(std::size_t face) const { return faceOffsets[face + 1] - faceOffsets[face]; }
    const double* record(std::size_t face, std::size_t corner) const
    {
        return values.data() +
               (faceOffsets[face] + corner) * static_cast<std::size_t>(format.stride());
    }
    glm::dvec3 position(std::size_t face, std::size_t corner) const
    {
        const double* p = record(face, corner) + format.positionOffset();
        return {p[0], p[1], p[2]};
    }
    /// Twice the area, as a vector along the normal.
    glm::dvec3 normal(std::size_t face) const;
    void append(const RecordPolygon& polygon);
    void copyFace(std::size_t face, RecordPolygon& polygon) const;
};

/// Cuts one tetrahedron by surfaces of a family: appends a face for each of the depths at which it
/// has a cross section, in their order. A vertex on a surface belongs to its far side, the
/// orientation is that of polygonize(). INDEX_OUT_OF_RANGE, VALUE_INVALID.
OSGVOLUMIZER_CORE_EXPORT Status sample(const TetraSet& set, std::size_t tetrahedron,
                                       const SurfaceFamily& family,
                                       const std::vector<double>& depths, PolygonSet& out);

/// Appends the parts of all faces inside a half-open box, by voxel coordinates where the format has
/// them, else by positions. Every field is interpolated.
OSGVOLUMIZER_CORE_EXPORT void clip(const PolygonSet& in, const Box3d& box, PolygonSet& out);

/// Appends the parts of all faces inside a convex set of half-spaces of the position frame.
OSGVOLUMIZER_CORE_EXPORT void clip(const PolygonSet& in, const std::vector<Plane>& halfSpaces,
                                   PolygonSet& out);

} // namespace core
} // namespace osgVolumizer
