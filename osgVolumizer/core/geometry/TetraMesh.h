#pragma once

#include "../Export.h"
#include "../Status.h"
#include "TetraSet.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgVolumizer {
namespace core {

// Services for tetra meshes. All expect a valid set (TetraSet::validate).

/// Six times the signed volume of a tetrahedron.
OSGVOLUMIZER_CORE_EXPORT double orientation(const TetraSet& set, std::size_t tetrahedron);

/// Sum of the volumes, each counted positive.
OSGVOLUMIZER_CORE_EXPORT double volume(const TetraSet& set);

/// The neighbours of each tetrahedron.
struct Adjacency
{
    static constexpr std::int32_t NONE = -1;
    /// Neighbour of tetrahedron t over the face opposite its vertex i: neighbours[t][i], or NONE.
    std::vector<std::array<std::int32_t, 4>> neighbours;
    /// Tetrahedra that share a face with more than one other: no manifold. Such a face has no
    /// neighbours on any side.
    std::vector<std::uint32_t> nonManifold;
};

/// Two tetrahedra are neighbours where they share three vertex indices.
OSGVOLUMIZER_CORE_EXPORT Adjacency findAdjacency(const TetraSet& set);

/// Affine map from positions to voxel coordinates inside a tetrahedron. Expects voxel coordinates
/// in the format. SINGULAR_MATRIX for a tetrahedron without volume, INDEX_OUT_OF_RANGE.
OSGVOLUMIZER_CORE_EXPORT Result<glm::dmat4> positionToVoxel(const TetraSet& set,
                                                            std::size_t tetrahedron);

/// Finds the tetrahedron around a point: a tree of boxes, split in the middle of the longest axis.
class OSGVOLUMIZER_CORE_EXPORT PointLocator
{
public:
    struct Place
    {
        std::uint32_t tetrahedron = 0;
        glm::dvec4 weights{0.0}; ///< barycentric, sum 1
    };

    /// Keeps a reference: the set must outlive the locator.
    explicit PointLocator(const TetraSet& set);
    /// Points on shared faces belong to the tetrahedron with the lower number. Weights may fall
    /// below zero by 1e-12. Tetrahedra without volume hold no points.
    std::optional<Place> locate(const glm::dvec3& position) const;

private:
    struct Node
    {
        Box3d bounds;
        std::uint32_t begin = 0, end = 0;  ///< of _order
        std::uint32_t left = 0, right = 0; ///< children; 0 in a leaf
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end, int depth);

    const TetraSet& _set;
    std::vector<Node> _nodes;
    std::vector<std::uint32_t> _order;
};

} // namespace core
} // namespace osgVolumizer
