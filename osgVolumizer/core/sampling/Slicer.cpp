#include "Slicer.h"

#include "TetraCases.h"

#include <algorithm>
#include <new>
#include <string>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::size_t MAX_BINS = std::size_t(1) << 24;
constexpr std::size_t BLOCKS_PER_CHUNK = 8; ///< fewer are not worth a task

/// Which vertices of a tetrahedron lie on the near side of surface k.
#if defined(__SSE2__)
struct Passed
{
    __m128i v;
    Passed(int a, int b, int c, int d) : v(_mm_set_epi32(d, c, b, a)) {}
    unsigned beyond(int k) const
    {
        return static_cast<unsigned>(
            _mm_movemask_ps(_mm_castsi128_ps(_mm_cmpgt_epi32(v, _mm_set1_epi32(k)))));
    }
};
#else
struct Passed
{
    int v[4];
    Passed(int a, int b, int c, int d) : v{a, b, c, d} {}
    unsigned beyond(int k) const
    {
        return (v[0] > k ? 1u : 0u) | (v[1] > k ? 2u : 0u) | (v[2] > k ? 4u : 0u) |
               (v[3] > k ? 8u : 0u);
    }
};
#endif

/// Corners of the face of a case: 4 where two vertices are on either side, else 3.
std::uint32_t faceSize(std::uint64_t mask) { return 3u + ((0x1668u >> mask) & 1u); }

bool outside(const Box3d& box, const std::vector<Plane>& visible)
{
    for (const Plane& p : visible) {
        const glm::dvec3 best(p.normal.x > 0.0 ? box.max.x : box.min.x,
                              p.normal.y > 0.0 ? box.max.y : box.min.y,
                              p.normal.z > 0.0 ? box.max.z : box.min.z);
        if (p.distance(best) < 0.0) return true;
    }
    return false;
}

/// Whether a slice may coincide with a face in an upper plane of the clip box.
bool flushFace(const TetraBlocks& blocks, const TetraBlocks::Block& block,
               const TetraBlocks::Tetra& t, unsigned faces)
{
    double f[4];
    for (int k = 0; k < 4; ++k)
        f[k] = blocks.record(block.firstVertex + t.v[k])[blocks.recordSize() - 1];
    for (int i = 0; i < 4; ++i)
        if ((faces >> i & 1u) && f[(i + 1) % 4] == f[(i + 2) % 4] && f[(i + 1) % 4] == f[(i + 3) % 4])
            return true;
    return false;
}

} // namespace

void Slicer::countBlock(const SlicePlan& plan, Chunk& chunk, std::uint32_t blockIndex) const
{
    TetraBlocks& blocks = *plan.blocks;
    const TetraBlocks::Block& block = blocks.blocks[blockIndex];
    if (!plan.visible.empty() && outside(block.bounds, plan.visible)) return;
    const std::size_t size = blocks.recordSize();
    const int first = plan.firstSurface, last = first + plan.surfaceCount;
    const double scale = 1.0 / plan.lattice.spacing;
    int passed[TetraBlocks::MAX_VERTICES];
    int lowest = last, highest = first;
    double* record = blocks.record(block.firstVertex);
    for (std::uint32_t i = 0; i < block.vertexCount; ++i, record += size) {
        const double depth =
            depthOf(plan, record, blocks.sourceVertices[block.firstVertex + i]);
        const double f = (plan.lattice.farDepth - depth) * scale;
        record[size - 1] = f;
        passed[i] = surfacesPassed(f, first, last);
        lowest = std::min(lowest, passed[i]);
        highest = std::max(highest, passed[i]);
    }
    if (lowest == highest && !plan.primitive) return;

    const TetraBlocks::Tetra* tetra = blocks.tetrahedra.data() + block.firstTetra;
    const TetraBlocks::Place* place =
        blocks.places.empty() ? nullptr : blocks.places.data() + block.firstTetra;
    for (std::uint32_t t = 0; t < block.tetraCount; ++t) {
        const TetraBlocks::Tetra& v = tetra[t];
        const int a = passed[v.v[0]], b = passed[v.v[1]], c = passed[v.v[2]], d = passed[v.v[3]];
        const int low = std::min(std::min(a, b), std::min(c, d));
        const int high = std::max(std::max(a, b), std::max(c, d));
        if (place || plan.primitive) {
            const TetraBlocks::Place p = place ? place[t] : 0;
            if (p == TetraBlocks::OUTSIDE || (low == high && !plan.primitive)) continue;
            const unsigned faces = p >> TetraBlocks::FACE_SHIFT;
            if (p == TetraBlocks::CLIP || plan.primitive ||
                (faces && flushFace(blocks, block, v, faces))) {
                clipTetra(plan, block, v, chunk);
                continue;
            }
        }
        // Two entries are written whether they are needed or not: most tetrahedra meet none, one or two
        // surfaces, and a branch on the number would be mispredicted half of the time.
        const auto n = static_cast<std::size_t>(high - low);
        if (chunk.entries.size() < chunk.entryCount + n + 2)
            chunk.entries.resize(2 * chunk.entries.size() + n + 1024);
        std::uint64_t* e = chunk.entries.data() + chunk.entryCount;
        const Passed four(a, b, c, d);
        const std::uint64_t bits = std::uint64_t(t) << 8;
        e[0] = std::uint64_t(std::uint32_t(low)) << 32 | bits | four.beyond(low);
        e[1] = std::uint64_t(std::uint32_t(low + 1)) << 32 | bits | four.beyond(low + 1);
        for (std::size_t k = 2; k < n; ++k) {
            const int s = low + static_cast<int>(k);
            e[k] = std::uint64_t(std::uint32_t(s)) << 32 | bits | four.beyond(s);
        }
        chunk.entryCount += n;
    }
}

void Slicer::countChunk(const SlicePlan& plan, Chunk& chunk) const
{
    const std::size_t bins = static_cast<std::size_t>(plan.surfaceCount) *
                             static_cast<std::size_t>(plan.brickCount);
    chunk.fast.assign(bins, 0);
    chunk.clipped.assign(bins, 0);
    chunk.entryCount = 0;
    chunk.blockEntries.clear();
    chunk.bins.clear();
    chunk.sizes.clear();
    chunk.vertices.clear();
    chunk.spacings.clear();
    const TetraBlocks& blocks = *plan.blocks;
    const auto brickCount = static_cast<std::uint32_t>(plan.brickCount);
    for (std::uint32_t b = chunk.firstBlock; b < chunk.endBlock; ++b) {
        const std::size_t start = chunk.entryCount;
        countBlock(plan, chunk, b);
        chunk.blockEntries.push_back(static_cast<std::uint32_t>(chunk.entryCount));
        const std::uint32_t firstTetra = blocks.blocks[b].firstTetra;
        for (std::size_t i = start; i < chunk.entryCount; ++i) {
            const std::uint64_t e = chunk.entries[i];
            const auto surface = static_cast<std::size_t>((e >> 32)) -
                                 static_cast<std::size_t>(plan.firstSurface);
            std::size_t bin = static_cast<std::uint32_t>(plan.rank[surface]) * brickCount;
            if (!blocks.places.empty())
                bin += blocks.places[firstTetra + (e >> 8 & 0xffffffu)] & TetraBlocks::BOX_MASK;
            chunk.fast[bin] += count(1, faceSize(e & 15u));
        }
    }
    for (std::size_t f = 0; f < chunk.bins.size(); ++f)
        chunk.clipped[chunk.bins[f]] += count(1, chunk.sizes[f]);
}

bool Slicer::placeBins(const SlicePlan& plan, std::size_t chunkCount, PolygonizedFaces& out)
{
    std::uint64_t vertices = 0, faces = 0;
    for (std::size_t c = 0; c < chunkCount; ++c) {
        for (const Count n : _chunks[c].fast) vertices += vertexCount(n), faces += faceCount(n);
        for (const Count n : _chunks[c].clipped) vertices += vertexCount(n), faces += faceCount(n);
    }
    if (vertices > 0xffffffffu) return false;
    const auto stride = static_cast<std::size_t>(plan.blocks->format().stride());
    out.faces.format = plan.blocks->format();
    out.faces.vertices.resize(vertices * stride);
    out.faces.indices.resize(vertices);
    out.faces.faceOffsets.resize(faces + 1);
    out.faceSpacings.resize(plan.primitive ? faces : 0);
    out.ranges.resize(static_cast<std::size_t>(plan.surfaceCount) *
                      static_cast<std::size_t>(plan.brickCount));
    Count at = 0;
    for (std::size_t bin = 0; bin < out.ranges.size(); ++bin) {
        const Count start = at;
        for (std::size_t c = 0; c < chunkCount; ++c) {
            const Count n = _chunks[c].fast[bin];
            _chunks[c].fast[bin] = at;
            at += n;
        }
        for (std::size_t c = 0; c < chunkCount; ++c) {
            const Count n = _chunks[c].clipped[bin];
            _chunks[c].clipped[bin] = at;
            at += n;
        }
        out.ranges[bin] = {faceCount(start), faceCount(at) - faceCount(start), vertexCount(start),
                           vertexCount(at) - vertexCount(start)};
    }
    out.faces.faceOffsets[faces] = static_cast<std::uint32_t>(vertices);
    return true;
}

void Slicer::emitChunk(const SlicePlan& plan, Chunk& chunk, PolygonizedFaces& out) const
{
    const SliceTarget target{out.faces.vertices.data(), out.faces.faceOffsets.data()};
    emitFaces(plan, chunk, target);
    const auto stride = static_cast<std::size_t>(plan.blocks->format().stride());
    const float* from = chunk.vertices.data();
    for (std::size_t f = 0; f < chunk.bins.size(); ++f) {
        Count& cursor = chunk.clipped[chunk.bins[f]];
        const std::size_t size = chunk.sizes[f] * stride;
        std::copy(from, from + size, target.vertices + vertexCount(cursor) * stride);
        target.faceOffsets[faceCount(cursor)] = vertexCount(cursor);
        if (plan.primitive) out.faceSpacings[faceCount(cursor)] = chunk.spacings[f];
        cursor += count(1, chunk.sizes[f]);
        from += size;
    }
}

Status Slicer::run(const SlicePlan& plan, Executor* executor, PolygonizedFaces& out)
try {
    const std::size_t bins = static_cast<std::size_t>(plan.surfaceCount) *
                             static_cast<std::size_t>(plan.brickCount);
    if (bins > MAX_BINS)
        return {ErrorCode::TOO_LARGE, "polygonize: " + std::to_string(plan.surfaceCount) +
                                          " surfaces times " + std::to_string(plan.brickCount) +
                                          " bricks are more than 2^24."};
    // Each chunk counts for itself; with many bins that alone would cost more than it gains.
    const std::size_t blockCount = plan.blocks->blocks.size();
    std::size_t chunkCount = executor ? static_cast<std::size_t>(executor->concurrency()) : 1;
    chunkCount = std::min(chunkCount, blockCount / BLOCKS_PER_CHUNK);
    chunkCount = std::max<std::size_t>(1, std::min(chunkCount, MAX_BINS / std::max<std::size_t>(1, bins)));
    if (_chunks.size() < chunkCount) _chunks.resize(chunkCount);
    for (std::size_t c = 0; c < chunkCount; ++c) {
        _chunks[c].firstBlock = static_cast<std::uint32_t>(blockCount * c / chunkCount);
        _chunks[c].endBlock = static_cast<std::uint32_t>(blockCount * (c + 1) / chunkCount);
    }
    const auto forAll = [&](const auto& task) {
        if (chunkCount == 1) task(0);
        else
            executor->run(static_cast<int>(chunkCount), std::cref(task));
    };
    forAll([&](int c) { countChunk(plan, _chunks[static_cast<std::size_t>(c)]); });
    if (!placeBins(plan, chunkCount, out))
        return {ErrorCode::TOO_LARGE, "polygonize: the faces have more than 2^32 vertices."};
    forAll([&](int c) {
        emitChunk(plan, _chunks[static_cast<std::size_t>(c)], out);
        // Faces do not share vertices, and both are in the same order.
        const std::size_t n = out.faces.indices.size();
        const std::size_t begin = n * static_cast<std::size_t>(c) / chunkCount;
        const std::size_t end = n * static_cast<std::size_t>(c + 1) / chunkCount;
        std::uint32_t* indices = out.faces.indices.data();
        for (std::size_t i = begin; i < end; ++i) indices[i] = static_cast<std::uint32_t>(i);
    });
    return {};
} catch (const std::bad_alloc&) {
    return {ErrorCode::TOO_LARGE, "polygonize: the faces do not fit in memory."};
}

} // namespace core
} // namespace osgVolumizer
