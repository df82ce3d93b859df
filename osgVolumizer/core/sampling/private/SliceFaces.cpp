#include "../../private/LargePages.h"
#include "SliceScan.h"

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

bool Slicer::emitBlocks(const SlicePlan& plan, PolygonizedFaces& out)
{
    Work& work = _work;
    const TetraBlocks& blocks = *plan.blocks;
    const std::size_t stride = blocks.recordSize();
    const auto brickCount = static_cast<std::uint32_t>(plan.brickCount);
    std::size_t entry = 0;
    for (std::size_t b = 0; b < blocks.blocks.size(); ++b) {
        const BlockFaces& faces = work.blockFaces[b];
        if (entry == faces.endEntry) continue;
        const TetraBlocks::Block& block = blocks.blocks[b];
        if (b + 1 < blocks.blocks.size()) {
            const TetraBlocks::Block& next = blocks.blocks[b + 1];
            prefetch(_passed.data() + next.firstVertex, next.vertexCount);
            prefetch(_layers.data() + next.firstVertex, next.vertexCount);
            prefetch(blocks.record(next.firstVertex), next.vertexCount * stride);
        }
        packPassed(_passed.data() + block.firstVertex, faces.highest, work);
        listPoints(blocks.edges.data() + block.firstEdge, block.edgeCount,
                   _passed.data() + block.firstVertex, work);
        if (work.vertexCount + work.pointCount > 0xffffffffu) return false;
        growLarge(out.faces.vertices, (work.vertexCount + work.pointCount) * stride,
                  work.vertexCount * stride);
        writePoints(blocks, block, _layers.data() + block.firstVertex, faces.base, work,
                    out.faces.vertices.data() + work.vertexCount * stride);
        work.vertexCount += work.pointCount;

        Emission emission{};
        emission.entries = work.entries.data() + entry;
        emission.endEntries = work.entries.data() + faces.endEntry;
        emission.tetraEdges = blocks.tetraEdges.data() + block.firstTetra;
        emission.edgePoints = work.edgePoints.data();
        emission.brickCount = brickCount;
        emission.cursors =
            work.fast.data() + std::size_t(faces.base - plan.firstSurface) * brickCount;
        if (block.place == TetraBlocks::CLIP)
            emission.places = blocks.places.data() + block.firstTetra;
        else
            emission.cursors += block.place;
        emission.indices = out.faces.indices.data();
        emission.faceOffsets = out.faces.faceOffsets.data();
        emitFaces(emission);
        entry = faces.endEntry;
    }
    out.faces.vertices.resize(work.vertexCount * stride);
    emitClipped(plan, out);
    return true;
}

void Slicer::emitClipped(const SlicePlan& plan, PolygonizedFaces& out)
{
    Work& work = _work;
    std::uint32_t vertex = 0; // their points are in their place already
    for (std::size_t f = 0; f < work.bins.size(); ++f) {
        Count& cursor = work.clipped[work.bins[f]];
        out.faces.faceOffsets[faceCount(cursor)] = indexCount(cursor);
        if (plan.primitive) out.faceSpacings[faceCount(cursor)] = work.spacings[f];
        for (std::uint32_t k = 0; k < work.sizes[f]; ++k)
            out.faces.indices[indexCount(cursor) + k] = vertex++;
        cursor += count(1, work.sizes[f]);
    }
}

} // namespace core
} // namespace osgVolumizer
