#include "../../private/LargePages.h"
#include "SliceScan.h"

#include <algorithm>

namespace osgVolumizer {
namespace core {

namespace {

/// Asks for memory that is read in no order soon.
template <class T>
void prefetch(const T* from, std::size_t count)
{
    const char* p = reinterpret_cast<const char*>(from);
    for (const char* const end = p + count * sizeof(T); p < end; p += 64)
        __builtin_prefetch(p);
}

} // namespace

bool Slicer::emitChunk(const SlicePlan& plan, Chunk& chunk, PolygonizedFaces& out) const
{
    const TetraBlocks& blocks = *plan.blocks;
    const std::size_t stride = blocks.recordSize();
    const auto brickCount = static_cast<std::uint32_t>(plan.brickCount);
    std::size_t entry = 0;
    for (std::uint32_t b = chunk.firstBlock; b < chunk.endBlock; ++b) {
        const BlockFaces& faces = chunk.blockFaces[b - chunk.firstBlock];
        if (entry == faces.endEntry) continue;
        const TetraBlocks::Block& block = blocks.blocks[b];
        if (b + 1 < chunk.endBlock) {
            const TetraBlocks::Block& next = blocks.blocks[b + 1];
            prefetch(_passed.data() + next.firstVertex, next.vertexCount);
            prefetch(_layers.data() + next.firstVertex, next.vertexCount);
            prefetch(blocks.record(next.firstVertex), next.vertexCount * stride);
        }
        packPassed(_passed.data() + block.firstVertex, faces.highest, chunk);
        listPoints(blocks.edges.data() + block.firstEdge, block.edgeCount,
                   _passed.data() + block.firstVertex, chunk);
        if (!_countPoints) {
            if (chunk.vertexCount + chunk.pointCount > 0xffffffffu) return false;
            growLarge(out.faces.vertices, (chunk.vertexCount + chunk.pointCount) * stride,
                      chunk.vertexCount * stride);
        }
        writePoints(blocks, block, _layers.data() + block.firstVertex, faces.base, chunk,
                    out.faces.vertices.data() + chunk.vertexCount * stride);
        chunk.vertexCount += chunk.pointCount;

        Emission emission{};
        emission.entries = chunk.entries.data() + entry;
        emission.endEntries = chunk.entries.data() + faces.endEntry;
        emission.tetraEdges = blocks.tetraEdges.data() + block.firstTetra;
        emission.edgePoints = chunk.edgePoints.data();
        emission.brickCount = brickCount;
        emission.cursors =
            chunk.fast.data() + std::size_t(faces.base - plan.firstSurface) * brickCount;
        if (block.place == TetraBlocks::CLIP)
            emission.places = blocks.places.data() + block.firstTetra;
        else
            emission.cursors += block.place;
        emission.indices = out.faces.indices.data();
        emission.faceOffsets = out.faces.faceOffsets.data();
        emitFaces(emission);
        entry = faces.endEntry;
    }
    if (!_countPoints) out.faces.vertices.resize(chunk.vertexCount * stride);
    emitClipped(plan, chunk, out);
    return true;
}

void Slicer::emitClipped(const SlicePlan& plan, Chunk& chunk, PolygonizedFaces& out) const
{
    const std::size_t stride = plan.blocks->recordSize();
    if (_countPoints)
        std::copy_n(chunk.vertices.data(), chunk.valueCount,
                    out.faces.vertices.data() + chunk.clippedVertex * stride);
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
