#include "Slicer.h"

#include "TetraCases.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <new>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::size_t MAX_BINS = std::size_t(1) << 24;
constexpr std::size_t BLOCKS_PER_CHUNK = 8; ///< fewer are not worth a task

/// What one face of each case adds to its bin: 4 indices where two vertices are on either side,
/// else
/// 3. The cases without a face do not occur.
constexpr std::array<Slicer::Count, 16> FACE_COUNTS = [] {
    std::array<Slicer::Count, 16> counts{};
    for (std::size_t mask = 0; mask < 16; ++mask)
        counts[mask] = Slicer::count(1, static_cast<std::uint32_t>(TETRA_CASES[mask].count));
    return counts;
}();

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
        if ((faces >> i & 1u) && f[(i + 1) % 4] == f[(i + 2) % 4] &&
            f[(i + 1) % 4] == f[(i + 3) % 4])
            return true;
    return false;
}

} // namespace

void Slicer::depthRange(const SlicePlan& plan, const TetraBlocks::Block& block, double& nearest,
                        double& farthest)
{
    nearest = -std::numeric_limits<double>::infinity();
    farthest = std::numeric_limits<double>::infinity();
    if (plan.depths) return;
    const Box3d& box =
        plan.depthField == plan.blocks->clipField() ? block.clipBounds : block.bounds;
    double middle = 0.0, half = 0.0, size = 0.0;
    for (int a = 0; a < 3; ++a) {
        const double g = plan.gradient[a], center = 0.5 * (box.min[a] + box.max[a]);
        middle += g * (center - plan.corner[a]);
        half += std::abs(g) * 0.5 * (box.max[a] - box.min[a]);
        size += std::abs(g) * (std::abs(center) + std::abs(plan.corner[a]));
    }
    half += 1e-14 * (size + half);
    nearest = middle - half;
    farthest = middle + half;
}

void Slicer::countBlock(const SlicePlan& plan, Chunk& chunk, std::uint32_t blockIndex)
{
    TetraBlocks& blocks = *plan.blocks;
    const TetraBlocks::Block& block = blocks.blocks[blockIndex];
    if (!plan.visible.empty() && outside(block.bounds, plan.visible)) return;
    const std::size_t size = blocks.recordSize();
    const int first = plan.firstSurface, last = first + plan.surfaceCount;
    const double scale = 1.0 / plan.lattice.spacing;
    double nearest, farthest;
    depthRange(plan, block, nearest, farthest);
    const double layerMargin = 1e-9; // of a layer, for the rounding of what follows
    if (!plan.primitive &&
        surfacesPassed((plan.lattice.farDepth - farthest) * scale - layerMargin, first, last) ==
            surfacesPassed((plan.lattice.farDepth - nearest) * scale + layerMargin, first, last))
        return;
    int* passed = _passed.data() + block.firstVertex;
    int lowest = last, highest = first;
    double* record = blocks.record(block.firstVertex);
    for (std::uint32_t i = 0; i < block.vertexCount; ++i, record += size) {
        const double depth = depthOf(plan, record, blocks.sourceVertices[block.firstVertex + i]);
        const double f = (plan.lattice.farDepth - depth) * scale;
        record[size - 1] = f;
        passed[i] = surfacesPassed(f, first, last);
        lowest = std::min(lowest, passed[i]);
        highest = std::max(highest, passed[i]);
    }
    if (lowest == highest && !plan.primitive) return; // PRIMITIVE has layers of its own

    const std::size_t start = chunk.entryCount;
    const TetraBlocks::Tetra* tetra = blocks.tetrahedra.data() + block.firstTetra;
    const TetraBlocks::Place* place =
        blocks.places.empty() ? nullptr : blocks.places.data() + block.firstTetra;
    if (!place && !plan.general()) {
        listFaces(tetra, 0, block.tetraCount, passed, chunk);
    } else {
        // Runs of tetrahedra that are whole in their boxes go the fast way.
        std::uint32_t runStart = 0;
        for (std::uint32_t t = 0; t < block.tetraCount; ++t) {
            const TetraBlocks::Place p = place ? place[t] : 0;
            const bool flush = p < TetraBlocks::OUTSIDE && p > TetraBlocks::BOX_MASK &&
                               flushFace(blocks, block, tetra[t], p >> TetraBlocks::FACE_SHIFT);
            if (p < TetraBlocks::OUTSIDE && !flush && !plan.general()) continue;
            listFaces(tetra, runStart, t - runStart, passed, chunk);
            runStart = t + 1;
            if (p != TetraBlocks::OUTSIDE) clipTetra(plan, block, tetra[t], chunk);
        }
        listFaces(tetra, runStart, block.tetraCount - runStart, passed, chunk);
    }
    if (chunk.entryCount > start)
        chunk.vertexCount +=
            countPoints(blocks.edges.data() + block.firstEdge, block.edgeCount, passed);
}

void Slicer::countChunk(const SlicePlan& plan, Chunk& chunk)
{
    const std::size_t bins =
        static_cast<std::size_t>(plan.surfaceCount) * static_cast<std::size_t>(plan.brickCount);
    chunk.fast.assign(bins, 0);
    chunk.clipped.assign(bins, 0);
    chunk.entryCount = 0;
    chunk.vertexCount = 0;
    chunk.blockEntries.clear();
    chunk.bins.clear();
    chunk.sizes.clear();
    chunk.valueCount = 0;
    chunk.spacings.clear();
    const TetraBlocks& blocks = *plan.blocks;
    const auto brickCount = static_cast<std::uint32_t>(plan.brickCount);
    const int* const rank = plan.rank;
    const auto firstSurface = static_cast<std::uint32_t>(plan.firstSurface);
    for (std::uint32_t b = chunk.firstBlock; b < chunk.endBlock; ++b) {
        const std::size_t start = chunk.entryCount;
        countBlock(plan, chunk, b);
        chunk.blockEntries.push_back(chunk.entryCount);
        const TetraBlocks::Place* const places =
            blocks.places.empty() ? nullptr : blocks.places.data() + blocks.blocks[b].firstTetra;
        Count* const counts = chunk.fast.data();
        const std::uint64_t* const end = chunk.entries.data() + chunk.entryCount;
        for (const std::uint64_t* entry = chunk.entries.data() + start; entry != end; ++entry) {
            const std::uint64_t e = *entry;
            std::size_t bin = static_cast<std::uint32_t>(rank[(e >> 32) - firstSurface]);
            if (places)
                bin = bin * brickCount +
                      (places[static_cast<std::uint32_t>(e) >> 8] & TetraBlocks::BOX_MASK);
            counts[bin] += FACE_COUNTS[e & 15u];
        }
    }
    for (std::size_t f = 0; f < chunk.bins.size(); ++f)
        chunk.clipped[chunk.bins[f]] += count(1, chunk.sizes[f]);
}

bool Slicer::placeBins(const SlicePlan& plan, std::size_t chunkCount, PolygonizedFaces& out)
{
    std::uint64_t indices = 0, faces = 0, vertices = 0;
    const auto stride = static_cast<std::size_t>(plan.blocks->format().stride());
    for (std::size_t c = 0; c < chunkCount; ++c) {
        for (const Count n : _chunks[c].fast)
            indices += indexCount(n), faces += faceCount(n);
        for (const Count n : _chunks[c].clipped)
            indices += indexCount(n), faces += faceCount(n);
        const std::size_t own = _chunks[c].vertexCount;
        _chunks[c].vertexCount = vertices;
        vertices += own;
    }
    for (std::size_t c = 0; c < chunkCount; ++c) {
        _chunks[c].clippedVertex = vertices;
        vertices += _chunks[c].valueCount / stride;
    }
    if (indices > 0xffffffffu || vertices > 0xffffffffu) return false;
    out.faces.format = plan.blocks->format();
    out.faces.vertices.resize(vertices * stride);
    out.faces.indices.resize(indices);
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
        out.ranges[bin] = {faceCount(start), faceCount(at) - faceCount(start), indexCount(start),
                           indexCount(at) - indexCount(start)};
    }
    out.faces.faceOffsets[faces] = static_cast<std::uint32_t>(indices);
    return true;
}

Status Slicer::checkSize(const SlicePlan& plan)
{
    if (static_cast<std::size_t>(plan.surfaceCount) * static_cast<std::size_t>(plan.brickCount) <=
        MAX_BINS)
        return {};
    return {ErrorCode::TOO_LARGE, "polygonize: " + std::to_string(plan.surfaceCount) +
                                      " surfaces times " + std::to_string(plan.brickCount) +
                                      " bricks are more than 2^24."};
}

Status Slicer::run(const SlicePlan& plan, Executor* executor, PolygonizedFaces& out)
try {
    const std::size_t bins =
        static_cast<std::size_t>(plan.surfaceCount) * static_cast<std::size_t>(plan.brickCount);
    // Each chunk counts for itself; with many bins that alone would cost more than it gains.
    const std::size_t blockCount = plan.blocks->blocks.size();
    std::size_t chunkCount = executor ? static_cast<std::size_t>(executor->concurrency()) : 1;
    chunkCount = std::min(chunkCount, blockCount / BLOCKS_PER_CHUNK);
    chunkCount =
        std::max<std::size_t>(1, std::min(chunkCount, MAX_BINS / std::max<std::size_t>(1, bins)));
    if (_chunks.size() < chunkCount) _chunks.resize(chunkCount);
    for (std::size_t c = 0; c < chunkCount; ++c) {
        _chunks[c].firstBlock = static_cast<std::uint32_t>(blockCount * c / chunkCount);
        _chunks[c].endBlock = static_cast<std::uint32_t>(blockCount * (c + 1) / chunkCount);
    }
    const auto forAll = [&](const auto& task) {
        if (chunkCount == 1)
            task(0);
        else
            executor->run(static_cast<int>(chunkCount), std::cref(task));
    };
    _passed.resize(plan.blocks->sourceVertices.size());
    forAll([&](int c) { countChunk(plan, _chunks[static_cast<std::size_t>(c)]); });
    if (!placeBins(plan, chunkCount, out))
        return {ErrorCode::TOO_LARGE, "polygonize: the faces have more than 2^32 corners."};
    forAll([&](int c) { emitChunk(plan, _chunks[static_cast<std::size_t>(c)], out); });
    return {};
} catch (const std::bad_alloc&) {
    return {ErrorCode::TOO_LARGE, "polygonize: the faces do not fit in memory."};
}

} // namespace core
} // namespace osgVolumizer
