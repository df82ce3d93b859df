#pragma once

#include "../Parallel.h"
#include "../geometry/BoxIndex.h"
#include "../geometry/TetraBlocks.h"
#include "ClipRecords.h"
#include "Polygonize.h"
#include "SurfaceFamily.h"

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// What one pass over a blocked tetra set has to know. Depths are relative to an anchor, positions
/// and clip boxes to the origin of the blocks.
struct SlicePlan
{
    TetraBlocks* blocks = nullptr; ///< the spare value of each record receives the layer coordinate
    const BoxIndex* boxes = nullptr;
    /// Depth of a vertex: dot(gradient, field - corner), unless `depths` gives it per source vertex.
    int depthField = 0;
    glm::dvec3 gradient{0.0};
    glm::dvec3 corner{0.0};
    const double* depths = nullptr;
    SurfaceLattice lattice;
    int firstSurface = 0, surfaceCount = 0; ///< those that get faces
    const int* rank = nullptr;              ///< place in the output of surface firstSurface + i
    int brickCount = 1;
    bool primitive = false;
    /// Blocks that lie outside one of these half-spaces are left out.
    std::vector<Plane> visible;
};

/// Cuts blocks of tetrahedra in two passes: the first finds out which surfaces meet which tetrahedra
/// and counts, the second writes every face to its final place. Tetrahedra that need clipping are
/// cut in the first pass already and copied in the second. All memory is kept.
class Slicer
{
public:
    /// Fills faces, ranges and faceSpacings of `out`; leaves it alone on failure (TOO_LARGE).
    Status run(const SlicePlan& plan, Executor* executor, PolygonizedFaces& out);

    /// Depth of a vertex, from its record.
    static double depthOf(const SlicePlan& plan, const double* record, std::uint32_t source)
    {
        if (plan.depths) return plan.depths[source];
        const double* p = record + plan.depthField;
        return plan.gradient.x * (p[0] - plan.corner.x) + plan.gradient.y * (p[1] - plan.corner.y) +
               plan.gradient.z * (p[2] - plan.corner.z);
    }

    /// Faces and vertices of a bin in one number, so that one addition counts both.
    using Count = std::uint64_t;
    static constexpr Count count(std::uint32_t faces, std::uint32_t vertices)
    {
        return Count(faces) << 32 | vertices;
    }
    static std::uint32_t faceCount(Count c) { return static_cast<std::uint32_t>(c >> 32); }
    static std::uint32_t vertexCount(Count c) { return static_cast<std::uint32_t>(c); }

    /// The share of one thread: neighbouring blocks.
    struct Chunk
    {
        std::uint32_t firstBlock = 0, endBlock = 0;
        /// Faces to make, block after block: surface << 32 | tetrahedron of the block << 8 | case.
        std::vector<std::uint64_t> entries;
        std::size_t entryCount = 0;
        std::vector<std::uint32_t> blockEntries; ///< per block, the end of its entries
        std::vector<Count> fast, clipped;        ///< per bin: first counts, then cursors
        // Faces that were clipped, in the order of making.
        std::vector<std::uint32_t> bins;
        std::vector<std::uint8_t> sizes;
        std::vector<float> vertices;
        std::vector<float> spacings;
        RecordPolygon whole, part;
    };

private:
    void countChunk(const SlicePlan& plan, Chunk& chunk) const;
    void countBlock(const SlicePlan& plan, Chunk& chunk, std::uint32_t block) const;
    bool placeBins(const SlicePlan& plan, std::size_t chunkCount, PolygonizedFaces& out);
    void emitChunk(const SlicePlan& plan, Chunk& chunk, PolygonizedFaces& out) const;

    std::vector<Chunk> _chunks;
};

/// Where emitFaces() writes.
struct SliceTarget
{
    float* vertices;
    std::uint32_t* faceOffsets;
};

/// Makes the faces of `chunk.entries`, in vector registers as wide as the processor has.
void emitFaces(const SlicePlan& plan, Slicer::Chunk& chunk, const SliceTarget& target);

/// Cuts one tetrahedron the general way, clips the faces to the boxes and appends them to the chunk.
/// Expects the layer coordinates in the records.
void clipTetra(const SlicePlan& plan, const TetraBlocks::Block& block,
               const TetraBlocks::Tetra& tetra, Slicer::Chunk& chunk);

/// Number of surfaces on the near side of which a vertex with layer coordinate f lies. Surface k is at
/// k + 1/2, and a vertex on it belongs to its far side. The subtraction is exact wherever the
/// result matters: for f in [1/4, 1] by Sterbenz' lemma, above because f - 1/2 has no finer
/// digits than f.
inline int surfacesPassed(double f, int first, int last)
{
    double g = f - 0.5;
    g = g < first ? first : g;
    g = g > last ? last : g;
    const int n = static_cast<int>(g);
    return n + (g > n ? 1 : 0);
}

} // namespace core
} // namespace osgVolumizer
