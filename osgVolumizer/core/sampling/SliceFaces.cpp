#include "Slicer.h"
#include "TetraCases.h"

#include <algorithm>

namespace osgVolumizer {
namespace core {

namespace {

struct Target
{
    std::uint32_t* indices;
    std::uint32_t* faceOffsets;
};

/// Writes the faces of one block. All that the loop needs is in local variables, since the compiler
/// has to expect that its stores change anything else.
template <bool Bricks>
void emitEntries(const SlicePlan& plan, Slicer::Chunk& chunk, const TetraBlocks::Block& block,
                 std::size_t begin, std::size_t end, Target target)
{
    const TetraBlocks& blocks = *plan.blocks;
    const TetraBlocks::TetraEdges* const tetraEdges = blocks.tetraEdges.data() + block.firstTetra;
    const TetraBlocks::Place* const places =
        Bricks ? blocks.places.data() + block.firstTetra : nullptr;
    const auto brickCount = static_cast<std::uint32_t>(plan.brickCount);
    const std::uint32_t* const edgePoints = chunk.edgePoints.data();
    const int* const rank = plan.rank;
    const auto firstSurface = static_cast<std::uint32_t>(plan.firstSurface);
    Slicer::Count* const cursors = chunk.fast.data();
    const std::uint64_t* const last = chunk.entries.data() + end;
    for (const std::uint64_t* entry = chunk.entries.data() + begin; entry != last; ++entry) {
        const std::uint64_t e = *entry;
        const auto surface = static_cast<std::uint32_t>(e >> 32);
        const std::uint32_t t = static_cast<std::uint32_t>(e) >> 8;
        const TetraCase& which = TETRA_CASES[e & 15u];
        std::size_t bin = static_cast<std::uint32_t>(rank[surface - firstSurface]);
        if (Bricks) bin = bin * brickCount + (places[t] & TetraBlocks::BOX_MASK);
        const Slicer::Count cursor = cursors[bin];
        cursors[bin] = cursor + Slicer::count(1, static_cast<std::uint32_t>(which.count));
        target.faceOffsets[Slicer::faceCount(cursor)] = Slicer::indexCount(cursor);
        std::uint32_t* const to = target.indices + Slicer::indexCount(cursor);
        const std::uint16_t* const edges = tetraEdges[t].e;
        to[0] = edgePoints[edges[which.edge[0]]] + surface;
        to[1] = edgePoints[edges[which.edge[1]]] + surface;
        to[2] = edgePoints[edges[which.edge[2]]] + surface;
        // Of a triangle the last corner is the third once more.
        to[which.count - 1] = edgePoints[edges[which.edge[3]]] + surface;
    }
}

} // namespace

void Slicer::emitChunk(const SlicePlan& plan, Chunk& chunk, PolygonizedFaces& out) const
{
    const TetraBlocks& blocks = *plan.blocks;
    const Target target{out.faces.indices.data(), out.faces.faceOffsets.data()};
    std::size_t i = 0;
    for (std::uint32_t b = chunk.firstBlock; b < chunk.endBlock; ++b) {
        const std::size_t end = chunk.blockEntries[b - chunk.firstBlock];
        if (i == end) continue;
        const TetraBlocks::Block& block = blocks.blocks[b];
        listPoints(blocks.edges.data() + block.firstEdge, block.edgeCount,
                   _passed.data() + block.firstVertex, chunk);
        writePoints(blocks, block, chunk,
                    out.faces.vertices.data() + chunk.vertexCount * (blocks.recordSize() - 1));
        chunk.vertexCount += chunk.pointCount;

        if (blocks.places.empty())
            emitEntries<false>(plan, chunk, block, i, end, target);
        else
            emitEntries<true>(plan, chunk, block, i, end, target);
        i = end;
    }
    emitClipped(plan, chunk, out);
}

void Slicer::emitClipped(const SlicePlan& plan, Chunk& chunk, PolygonizedFaces& out) const
{
    const auto stride = static_cast<std::size_t>(plan.blocks->format().stride());
    std::copy(chunk.vertices.begin(),
              chunk.vertices.begin() + static_cast<std::ptrdiff_t>(chunk.valueCount),
              out.faces.vertices.begin() +
                  static_cast<std::ptrdiff_t>(chunk.clippedVertex * stride));
    auto vertex = static_cast<std::uint32_t>(chunk.clippedVertex);
    for (std::size_t f = 0; f < chunk.bins.size(); ++f) {
        Count& cursor = chunk.clipped[chunk.bins[f]];
        out.faces.faceOffsets[faceCount(cursor)] = indexCount(cursor);
        if (plan.primitive) out.faceSpacings[faceCount(cursor)] = chunk.spacings[f];
        for (std::uint32_t k = 0; k < chunk.sizes[f]; ++k)
            out.faces.indices[indexCount(cursor) + k] = vertex++;
        cursor += count(1, chunk.sizes[f]);
    }
}

} // namespace core
} // namespace osgVolumizer
