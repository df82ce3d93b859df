#pragma once

#include "../Export.h"
#include "Box.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A bounded convex polytope by its boundary: shared vertices, and polygons that run
/// counter-clockwise seen from outside. Every face carries the tag of the plane it lies in.
/// Clipping reuses the memory of earlier calls, so an instance that is kept allocates nothing in
/// the end.
class OSGVOLUMIZER_CORE_EXPORT ConvexPolytope
{
public:
    std::vector<glm::dvec3> vertices;
    std::vector<std::uint32_t> indices; ///< polygons, one after another
    std::vector<std::uint32_t>
        faceOffsets;           ///< face f is indices [faceOffsets[f], faceOffsets[f+1])
    std::vector<int> faceTags; ///< one per face

    std::size_t faceCount() const { return faceTags.size(); }
    bool empty() const { return faceTags.empty(); }
    void clear();
    /// Becomes a box; tags 0 to 5 are x min, x max, y min, y max, z min, z max. An empty or flat
    /// box gives an empty polytope.
    void setBox(const Box3d& box);
    /// Copies the shape of another, keeping this one's memory.
    void assign(const ConvexPolytope& other);
    /// Keeps the part inside the half-space; the face that closes it gets the tag. Vertices nearer
    /// to the plane than 1e-13 of the coordinates' magnitude count as on it, so no slivers of that
    /// size arise; what has no volume becomes empty.
    void clip(const Plane& plane, int tag);
    double volume() const;
    /// Outward normal of a face, not normalised: its length is twice the area.
    glm::dvec3 faceNormal(std::size_t face) const;

private:
    std::uint32_t cut(std::uint32_t inside, std::uint32_t outside);
    void clipFace(std::size_t face);
    void closeWith(int tag);
    void compact();

    // Scratch of clip(): signed distances, cut edges and their points, the new boundary.
    struct Cut
    {
        std::uint32_t inside, outside, vertex;
    };
    std::vector<double> _distances;
    std::vector<Cut> _cuts;
    std::vector<std::uint32_t> _indices, _offsets, _next;
    std::vector<int> _tags;
};

} // namespace core
} // namespace osgVolumizer
