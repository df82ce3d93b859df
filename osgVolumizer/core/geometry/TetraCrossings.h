#pragma once

#include "../Export.h"
#include "Box.h"
#include "TetraSet.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Finds the tetrahedra that a segment crosses: a tree of boxes, split in the middle of the longest
/// axis. Immutable; thread safe.
class OSGVOLUMIZER_CORE_EXPORT TetraCrossings
{
public:
    /// A tetrahedron's part of a segment. Parameters run from 0 at its start to 1 at its end;
    /// barycentric weights, and so all that vertices carry, are linear between the two.
    struct Crossing
    {
        std::uint32_t tetrahedron = 0;
        double begin = 0.0, end = 0.0;
        glm::dvec4 beginWeights{0.0}, endWeights{0.0};
    };

    /// Expects a valid set (TetraSet::validate). Tetrahedra without volume are crossed by nothing.
    explicit TetraCrossings(std::shared_ptr<const TetraSet> set);

    /// In the order of where they begin. Neighbours meet to a rounding error: weights may fall
    /// below zero by 1e-12, so that no segment slips through between two.
    std::vector<Crossing> find(const glm::dvec3& start, const glm::dvec3& end) const;

private:
    struct Node
    {
        Box3d bounds;
        std::uint32_t begin = 0, end = 0;  ///< of _order
        std::uint32_t left = 0, right = 0; ///< children; 0 in a leaf
    };

    std::uint32_t build(const std::vector<Box3d>& boxes, std::uint32_t begin, std::uint32_t end);
    bool cross(std::uint32_t tetrahedron, const glm::dvec3& start, const glm::dvec3& end,
               Crossing& crossing) const;

    std::shared_ptr<const TetraSet> _set;
    std::vector<Node> _nodes;
    std::vector<std::uint32_t> _order;
};

/// Narrows a part [begin, end] of a segment, parameters as above, to a half-space; false where
/// nothing is left.
OSGVOLUMIZER_CORE_EXPORT bool cutSegment(const Plane& plane, const glm::dvec3& start,
                                         const glm::dvec3& end, double& beginParameter,
                                         double& endParameter);
/// The same to a box, faces included.
OSGVOLUMIZER_CORE_EXPORT bool cutSegment(const Box3d& box, const glm::dvec3& start,
                                         const glm::dvec3& end, double& beginParameter,
                                         double& endParameter);

/// Where a segment goes through the boundary of a tetra set.
struct BoundaryCrossing
{
    std::uint32_t tetrahedron = 0;             ///< behind the face
    std::array<TetraSet::Index, 3> vertices{}; ///< counter-clockwise from outside
    double parameter = 0.0;                    ///< 0 at the start of the segment, 1 at its end
    bool enters = false;                       ///< else it leaves
};

/// The boundary faces (of one tetrahedron only, see findAdjacency()) that a segment goes through,
/// from its start to its end. Which side of an edge it passes is decided without rounding, and of
/// an edge that it meets, so that it enters as often as it leaves. Faces that it only runs along
/// are not. Expects a valid set. Cost O(tetrahedra).
OSGVOLUMIZER_CORE_EXPORT std::vector<BoundaryCrossing>
boundaryCrossings(const TetraSet& set, const glm::dvec3& start, const glm::dvec3& end);

} // namespace core
} // namespace osgVolumizer
