#pragma once

#include "../Export.h"
#include "TetraSet.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A tetrahedral mesh the way that rays walk through it, from tetrahedron to tetrahedron over the
/// faces that these share (Weiler, Kraus, Merz and Ertl, "Hardware-based ray casting for
/// tetrahedral meshes", IEEE Visualization 2003). Whoever knows three vertices of a tetrahedron
/// finds the fourth by exclusive or (Aman, Demirci and Gudukbay, "Compact tetrahedralization-based
/// acceleration structures for ray tracing", Journal of Visualization 25, 2022), so that a
/// tetrahedron takes 20 bytes. Where rays come in from outside is found in a tree of boxes over the
/// faces that have a tetrahedron on one side only. No mesh is too irregular: rays need no order of
/// tetrahedra, and so cycles, holes, several pieces and faces that do not match are all the same.
struct OSGVOLUMIZER_CORE_EXPORT TetraGraph
{
    static constexpr std::uint32_t OUTSIDE = 0xffffffffu; ///< instead of a neighbour
    static constexpr std::size_t CELL_WORDS = 5, FACE_WORDS = 4;

    /// One after another:
    /// CELL_WORDS a tetrahedron: its vertices, exclusive or; then its neighbours over the faces
    /// opposite its vertices, by ascending index of vertex.
    /// FACE_WORDS an outer face: its vertices, counter-clockwise from outside, and its tetrahedron.
    std::vector<std::uint32_t> words;
    std::size_t facesBegin = 0; ///< in words
    std::size_t cellCount = 0, faceCount = 0;
    /// The lowest and the highest corner of each node, a little outwards, one after another; both
    /// far away where there are no faces. Node 1 is the root, node n has children 2n and 2n + 1;
    /// nothing is at 0. The last `leafCount` nodes are leaves, with `leafFaces` outer faces each,
    /// in their order, but for the last ones.
    std::vector<glm::vec3> boxes;
    std::size_t leafCount = 1, leafFaces = 1;
    /// Of each tetrahedron, the number that it has in the set.
    std::vector<std::uint32_t> numbers;

    // What is odd about the mesh.
    std::size_t repeatedVertices = 0; ///< tetrahedra with one vertex twice: left out
    std::size_t twice = 0;            ///< of the same four vertices as another: left out
    std::size_t flat = 0;             ///< without volume: passed through, and nothing of them seen
    std::size_t inverted = 0;         ///< of negative orientation, where that is not the rule
    std::size_t nonManifoldFaces = 0; ///< of more than two tetrahedra: as outer faces of each
    /// Whether anything is left out, or drawn otherwise than may be meant.
    bool isOdd() const { return repeatedVertices + twice + flat + nonManifoldFaces > 0; }
    /// A sentence on what is left out or not as it should be; empty where nothing is.
    std::string oddities() const;
};

/// Expects a valid set (TetraSet::validate). O(n log n).
OSGVOLUMIZER_CORE_EXPORT TetraGraph makeTetraGraph(const TetraSet& set);

} // namespace core
} // namespace osgVolumizer
