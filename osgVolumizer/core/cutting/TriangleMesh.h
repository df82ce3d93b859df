#pragma once

#include "../Export.h"
#include "../Status.h"
#include "../geometry/Box.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Triangles over shared vertices, three indices each, in whatever frame the owner says.
struct OSGVOLUMIZER_CORE_EXPORT TriangleMesh
{
    std::vector<glm::dvec3> vertices;
    std::vector<std::uint32_t> indices;

    std::size_t triangleCount() const { return indices.size() / 3; }
    const glm::dvec3& corner(std::size_t triangle, int i) const
    {
        return vertices[indices[3 * triangle + static_cast<std::size_t>(i)]];
    }
    Box3d bounds() const;
    /// Refuses (VALUE_INVALID) no triangles, indices without a vertex, and vertices that are not
    /// finite.
    Status validate() const;
};

/// Vertices nearer than a tolerance become one; triangles that have a
/// corner twice go. Expects a mesh that validate() accepts.
OSGVOLUMIZER_CORE_EXPORT TriangleMesh welded(const TriangleMesh& mesh, double tolerance = 0.0);

/// Whether a welded mesh has an inside: refuses (VALUE_INVALID) what validate() does, and, with the
/// place of one, edges that an odd number of triangles share. Triangles may run either way round;
/// what they enclose twice is outside.
OSGVOLUMIZER_CORE_EXPORT Status checkClosed(const TriangleMesh& mesh);

/// The half-spaces whose intersection a closed mesh encloses, where that is convex and has no more
/// than `most` faces (triangles in one plane are one face); else none.
OSGVOLUMIZER_CORE_EXPORT std::vector<Plane> convexFaces(const TriangleMesh& mesh, std::size_t most);

/// Squared distance from a point to a triangle (Ericson, "Real-Time Collision Detection", 5.1.5).
OSGVOLUMIZER_CORE_EXPORT double squaredDistance(const glm::dvec3& p, const glm::dvec3& a,
                                                const glm::dvec3& b, const glm::dvec3& c);

} // namespace core
} // namespace osgVolumizer
