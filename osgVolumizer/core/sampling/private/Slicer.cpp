#include "../../private/LargePages.h"
#include "SliceScan.h"

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
bool flushFace(const double* layers, const TetraBlocks::Tetra& t, unsigned faces)
{
    double f[4];
    for (int k = 0; k < 4; ++k)
        f[k] = layers[t.v[k]];
    for (int i = 0; i < 4; ++i)
        if ((faces >> i & 1u) && f[(i + 1) % 4] == f[(i + 2) % 4] &&
            f[(i + 1) % 4] == f[(i + 3) % 4])
            return true;
    return false;
}

/// Adds up the faces per surface; the counts of neighbouring surfaces are `step` apart. Neighbours
/// in the list mostly meet the same surface, and a count in memory that changes twice in a row
/// costs a wait: so there are two counts of each surface.
void countFaces(const std::uint32_t* entry, const std::uint32_t* end, int surfaces,
                std::size_t step, Slicer::Count* counts)
{
    constexpr int MOST = 256;
    if (surfaces > MOST) {
        for (; entry != end; ++entry)
            counts[(*entry >> 14) * step] += FACE_COUNTS[*entry & 15u];
        return;
    }
    Slicer::Count even[MOST], odd[MOST];
    std::fill_n(even, surfaces, 0);
    std::fill_n(odd, surfaces, 0);
    for (; end - entry >= 2; entry += 2) {
        even[entry[0] >> 14] += FACE_COUNTS[entry[0] & 15u];
        odd[entry[1] >> 14] += FACE_COUNTS[entry[1] & 15u];
    }
    if (entry != end) even[*entry >> 14] += FACE_COUNTS[*entry & 15u];
    for (int k = 0; k < surfaces; ++k)
        counts[static_cast<std::size_t>(k) * step] += even[k] + odd[k];
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

Slicer::BlockFaces Slicer::countBlock(const SlicePlan& plan, const TetraBlocks::Block& block)
{
    Work& work = _work;
    const TetraBlocks& blocks = *plan.blocks;
    int base = plan.firstSurface, end = base + plan.surfaceCount;
    if (block.place == TetraBlocks::OUTSIDE) return {work.entryCount, base, 0};
    if (!plan.visible.empty() && outside(block.bounds, plan.visible))
        return {work.entryCount, base, 0};
    double nearest, farthest;
    depthRange(plan, block, nearest, farthest);
    const double layerMargin = 1e-9; // of a layer, for the rounding of what follows
    if (!plan.primitive) {           // which has layers of its own
        const double scale = 1.0 / plan.lattice.spacing;
        const int first = base, last = end;
        base =
            surfacesPassed((plan.lattice.farDepth - farthest) * scale - layerMargin, first, last);
        end = surfacesPassed((plan.lattice.farDepth - nearest) * scale + layerMargin, first, last);
        if (base == end) return {work.entryCount, base, 0};
    }
    double* layers = _layers.data() + block.firstVertex;
    int* passed = _passed.data() + block.firstVertex;
    const PassedRange range = listLayers(plan, block, base, end, layers, passed);
    if (range.lowest >= range.highest && !plan.primitive) return {work.entryCount, base, 0};

    packPassed(passed, range.highest, work);
    const bool general = plan.general() || range.highest > MAX_BLOCK_SURFACES;
    const TetraBlocks::Tetra* tetra = blocks.tetrahedra.data() + block.firstTetra;
    if (block.place != TetraBlocks::CLIP && !general) {
        listFaces(tetra, 0, block.tetraCount, passed, work);
    } else {
        // Runs of tetrahedra that are whole in their boxes go the fast way.
        std::uint32_t runStart = 0;
        for (std::uint32_t t = 0; t < block.tetraCount; ++t) {
            const TetraBlocks::Place p = block.place == TetraBlocks::CLIP
                                             ? blocks.places[block.firstTetra + t]
                                             : block.place;
            const bool flush = p < TetraBlocks::OUTSIDE && p > TetraBlocks::BOX_MASK &&
                               flushFace(layers, tetra[t], p >> TetraBlocks::FACE_SHIFT);
            if (p < TetraBlocks::OUTSIDE && !flush && !general) continue;
            listFaces(tetra, runStart, t - runStart, passed, work);
            runStart = t + 1;
            if (p != TetraBlocks::OUTSIDE) clipTetra(plan, block, t, layers, work);
        }
        listFaces(tetra, runStart, block.tetraCount - runStart, passed, work);
    }
    return {work.entryCount, base, range.highest};
}

void Slicer::countBlocks(const SlicePlan& plan)
{
    Work& work = _work;
    const std::size_t bins =
        static_cast<std::size_t>(plan.surfaceCount) * static_cast<std::size_t>(plan.brickCount);
    work.fast.assign(bins, 0);
    work.clipped.assign(bins, 0);
    work.entryCount = 0;
    work.blockFaces.clear();
    work.bins.clear();
    work.sizes.clear();
    work.valueCount = 0;
    work.spacings.clear();
    const TetraBlocks& blocks = *plan.blocks;
    const auto brickCount = static_cast<std::size_t>(plan.brickCount);
    for (const TetraBlocks::Block& block : blocks.blocks) {
        const std::size_t start = work.entryCount;
        const BlockFaces faces = countBlock(plan, block);
        work.blockFaces.push_back(faces);
        if (faces.endEntry == start) continue;
        Count* counts = work.fast.data() +
                        static_cast<std::size_t>(faces.base - plan.firstSurface) * brickCount;
        const std::uint32_t* entry = work.entries.data() + start;
        const std::uint32_t* const end = work.entries.data() + work.entryCount;
        if (block.place != TetraBlocks::CLIP) {
            countFaces(entry, end, faces.highest, brickCount, counts + block.place);
            continue;
        }
        const TetraBlocks::Place* const places = blocks.places.data() + block.firstTetra;
        for (; entry != end; ++entry)
            counts[(*entry >> 14) * brickCount +
                   (places[*entry >> 4 & 0x3ffu] & TetraBlocks::BOX_MASK)] +=
                FACE_COUNTS[*entry & 15u];
    }
    for (std::size_t f = 0; f < work.bins.size(); ++f)
        work.clipped[work.bins[f]] += count(1, work.sizes[f]);
}

bool Slicer::placeBins(const SlicePlan& plan, PolygonizedFaces& out)
{
    std::uint64_t indices = 0, faces = 0;
    for (const std::vector<Count>* counts : {&_work.fast, &_work.clipped})
        for (const Count n : *counts)
            indices += indexCount(n), faces += faceCount(n);
    _work.vertexCount = _work.valueCount / plan.blocks->recordSize();
    if (indices > 0xffffffffu || _work.vertexCount > 0xffffffffu) return false;
    out.faces.format = plan.blocks->format();
    resizeLarge(out.faces.indices, indices);
    resizeLarge(out.faces.faceOffsets, faces + 1);
    out.faceSpacings.resize(plan.primitive ? faces : 0);
    out.ranges.resize(static_cast<std::size_t>(plan.surfaceCount) *
                      static_cast<std::size_t>(plan.brickCount));
    Count at = 0;
    const auto brickCount = static_cast<std::size_t>(plan.brickCount);
    for (std::size_t place = 0; place < out.ranges.size(); ++place) {
        const std::size_t bin =
            static_cast<std::size_t>(plan.order[place / brickCount]) * brickCount +
            place % brickCount;
        const Count start = at;
        for (std::vector<Count>* counts : {&_work.fast, &_work.clipped}) {
            const Count n = (*counts)[bin];
            (*counts)[bin] = at;
            at += n;
        }
        out.ranges[place] = {faceCount(start), faceCount(at) - faceCount(start), indexCount(start),
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

Status Slicer::run(const SlicePlan& plan, PolygonizedFaces& out)
try {
    // Some more, so that the last block's may be read in groups as well.
    resizeLarge(_passed, plan.blocks->sourceVertices.size() + TetraBlocks::MAX_VERTICES);
    resizeLarge(_layers, plan.blocks->sourceVertices.size());
    // Points of clipped faces are put into their place as they are made.
    _work.vertices.swap(out.faces.vertices);
    countBlocks(plan);
    _work.vertices.swap(out.faces.vertices);
    const bool fits = placeBins(plan, out) && emitBlocks(plan, out);
    if (fits) return {};
    out = PolygonizedFaces();
    return {ErrorCode::TOO_LARGE, "polygonize: the faces have more than 2^32 corners."};
} catch (const std::bad_alloc&) {
    out = PolygonizedFaces();
    return {ErrorCode::TOO_LARGE, "polygonize: the faces do not fit in memory."};
}

} // namespace core
} // namespace osgVolumizer
