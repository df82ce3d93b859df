#pragma once

#include "../Export.h"
#include "Box.h"
#include "BoxIndex.h"
#include "TetraSet.h"

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A tetra set cut into blocks of neighbouring tetrahedra with vertices and edges of their own, so
/// that one block stays in the first-level cache and is culled by one box test. Tetrahedra are
/// taken along a Morton curve; all get positive orientation.
class OSGVOLUMIZER_CORE_EXPORT TetraBlocks
{
public:
    static constexpr std::size_t MAX_VERTICES = 256; ///< of a block: indices are bytes
    static constexpr std::size_t MAX_TETRAHEDRA = 1024;

    struct Block
    {
        std::uint32_t firstVertex = 0, vertexCount = 0;
        std::uint32_t firstTetra = 0, tetraCount = 0;
        std::uint32_t firstEdge = 0, edgeCount = 0;
        Box3d bounds;     ///< of the positions, relative to the origin
        Box3d clipBounds; ///< of what clipField() tells
        /// The place of all its tetrahedra, where that is OUTSIDE or a box without faces in its
        /// upper planes; else CLIP.
        std::uint32_t place = 0;
    };
    struct Tetra
    {
        std::uint8_t v[4]; ///< vertices of the block
    };
    struct TetraEdges
    {
        std::uint16_t e[6]; ///< edges of the block: 01 02 03 12 13 23
    };
    struct Edge
    {
        std::uint8_t a, b; ///< vertices of the block
    };

    /// The place of a tetrahedron among the clip boxes: CLIP, OUTSIDE, or the box that holds all of
    /// it in its low bits, with bit FACE_SHIFT + i set where the face opposite vertex i lies in an
    /// upper plane of the box. Such a face belongs to the next box, if it is a slice.
    using Place = std::uint32_t;
    static constexpr Place CLIP = 0xffffffffu;
    static constexpr Place OUTSIDE = 0xfffffffeu;
    static constexpr int FACE_SHIFT = 27;
    static constexpr Place BOX_MASK = (1u << FACE_SHIFT) - 1;

    std::vector<Block> blocks;
    std::vector<Tetra> tetrahedra;
    std::vector<TetraEdges> tetraEdges; ///< one more than tetrahedra: reading 16 bytes is safe
    std::vector<Edge> edges;
    std::vector<std::uint32_t> sourceVertices; ///< of each vertex: its number in the tetra set
    std::vector<std::uint32_t> sourceTetrahedra;
    /// Records of recordSize() values: those of the tetra set, positions relative to the origin.
    /// Some values more at the end, so that any three may be read as a group of four.
    std::vector<double> records;
    std::vector<Place> places; ///< one per tetrahedron where there are clip boxes, else empty

    const VertexFormat& format() const { return _format; }
    std::size_t recordSize() const { return static_cast<std::size_t>(_format.stride()); }
    const glm::dvec3& origin() const { return _origin; }
    const double* record(std::size_t vertex) const
    {
        return records.data() + vertex * recordSize();
    }
    /// Field that clip boxes apply to: voxel coordinates, or else positions.
    int clipField() const
    {
        return _format.voxelCoordinateSize == 3 ? _format.voxelCoordinateOffset()
                                                : _format.positionOffset();
    }

    /// Expects a valid set.
    void build(const TetraSet& set, const glm::dvec3& origin);
    /// Finds every tetrahedron's place. Boxes are in the frame of clipField(), less the origin
    /// where that is the position.
    void place(const BoxIndex& boxes);

private:
    void sortTetrahedra(const TetraSet& set);
    void findEdges();
    Place placeOf(const BoxIndex& boxes, const Block& block, const Tetra& tetra) const;

    VertexFormat _format;
    glm::dvec3 _origin{0.0};
    std::vector<std::uint64_t> _codes; ///< scratch of sortTetrahedra()
    std::vector<std::uint32_t> _stamps, _local;
    /// Number of the edge between two vertices of a block, as stamped by the block.
    struct EdgeEntry
    {
        std::uint32_t block;
        std::uint16_t edge;
    };
    std::vector<EdgeEntry> _edgeTable;
};

} // namespace core
} // namespace osgVolumizer
