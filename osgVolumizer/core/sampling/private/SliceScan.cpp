#include "SliceScan.h"

#include "TetraCases.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>

namespace osgVolumizer {
namespace core {

namespace {

std::atomic<Instructions> instructions{Instructions::AVX512};

} // namespace

void limitInstructions(Instructions most)
{
    instructions = most;
}
Instructions instructionLimit()
{
    return instructions.load(std::memory_order_relaxed);
}

// Most tetrahedra and edges meet none, one or two surfaces of a lattice that is as fine as they
// are, and a branch on that number would be mispredicted half of the time. So two are always
// written, and the end of the list moves on by the number that counts.

PassedRange listLayers(const SlicePlan& plan, const TetraBlocks::Block& block, int base, int end,
                       double* layers, int* passed)
{
    const TetraBlocks& blocks = *plan.blocks;
    const double* record = blocks.record(block.firstVertex);
    const std::size_t stride = blocks.recordSize();
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    if (!plan.depths && avx2::available())
        return avx2::listLayers(plan, record, stride, block.vertexCount, base, end, layers, passed);
#endif
    const std::uint32_t* sources = blocks.sourceVertices.data() + block.firstVertex;
    PassedRange range{end - base, 0};
    for (std::uint32_t i = 0; i < block.vertexCount; ++i, record += stride)
        listLayer(plan, Slicer::depthOf(plan, record, sources[i]), base, end, layers[i], passed[i],
                  range);
    return range;
}

void packPassed(const int* passed, int highest, Slicer::Work& work)
{
    work.hasPassedBytes = false;
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    if (highest > 0xff || !avx512::available()) return;
    avx512::packPassed(passed, work);
    work.hasPassedBytes = true;
#else
    (void)passed, (void)highest;
#endif
}

void listFace(const TetraBlocks::Tetra& v, std::uint32_t t, const int* passed, Slicer::Work& work)
{
    const int a = passed[v.v[0]], b = passed[v.v[1]], c = passed[v.v[2]], d = passed[v.v[3]];
    const int low = std::min(std::min(a, b), std::min(c, d));
    const auto n = static_cast<std::size_t>(std::max(std::max(a, b), std::max(c, d)) - low);
    const auto entry = [&](int k) {
        const unsigned mask =
            (a > k ? 1u : 0u) | (b > k ? 2u : 0u) | (c > k ? 4u : 0u) | (d > k ? 8u : 0u);
        return static_cast<std::uint32_t>(k) << 14 | t << 4 | mask;
    };
    growLarge(work.entries, work.entryCount + n + 2, work.entryCount);
    std::uint32_t* e = work.entries.data() + work.entryCount;
    e[0] = entry(low);
    e[1] = entry(low + 1);
    for (std::size_t k = 2; k < n; ++k)
        e[k] = entry(low + static_cast<int>(k));
    work.entryCount += n;
}

void listEdge(const TetraBlocks::Edge& e, std::uint32_t i, const int* passed, Slicer::Work& work)
{
    const int a = passed[e.a], b = passed[e.b];
    const auto low = static_cast<std::uint32_t>(std::min(a, b));
    const auto n = static_cast<std::uint32_t>(std::abs(a - b));
    const std::uint32_t ends =
        a < b ? e.a | std::uint32_t(e.b) << 8 : e.b | std::uint32_t(e.a) << 8;
    growLarge(work.points, work.pointCount + n + 2, work.pointCount);
    std::uint32_t* to = work.points.data() + work.pointCount;
    to[0] = low << 16 | ends;
    to[1] = (low + 1) << 16 | ends;
    for (std::uint32_t k = 2; k < n; ++k)
        to[k] = (low + k) << 16 | ends;
    work.edgePoints[i] = static_cast<std::uint32_t>(work.vertexCount + work.pointCount) - low;
    work.pointCount += n;
}

void listFaces(const TetraBlocks::Tetra* tetrahedra, std::uint32_t first, std::uint32_t count,
               const int* passed, Slicer::Work& work)
{
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    const std::uint32_t end = first + count;
    if (work.hasPassedBytes) first = avx512::listFaces(tetrahedra, first, end, passed, work);
    if (avx2::available()) {
        avx2::listFaces(tetrahedra, first, end, passed, work);
        return;
    }
#endif
    for (std::uint32_t t = first; t < first + count; ++t)
        listFace(tetrahedra[t], t, passed, work);
}

void listPoints(const TetraBlocks::Edge* edges, std::uint32_t count, const int* passed,
                Slicer::Work& work)
{
    growLarge(work.edgePoints, count);
    work.pointCount = 0;
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    if (work.hasPassedBytes) {
        std::uint32_t i = avx512::listPoints(edges, count, passed, work);
        for (; i < count; ++i)
            listEdge(edges[i], i, passed, work);
        return;
    }
    if (avx2::available()) {
        avx2::listPoints(edges, count, passed, work);
        return;
    }
#endif
    for (std::uint32_t i = 0; i < count; ++i)
        listEdge(edges[i], i, passed, work);
}

void emitFaces(const Emission& in)
{
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    if (avx2::available()) {
        avx2::emitFaces(in);
        return;
    }
#endif
    for (const std::uint32_t* entry = in.entries; entry != in.endEntries; ++entry) {
        const std::uint32_t e = *entry, surface = e >> 14, t = e >> 4 & 0x3ffu;
        const TetraCase& which = TETRA_CASES[e & 15u];
        std::size_t bin = std::size_t(surface) * in.brickCount;
        if (in.places) bin += in.places[t] & TetraBlocks::BOX_MASK;
        const Slicer::Count cursor = in.cursors[bin];
        in.cursors[bin] = cursor + Slicer::count(1, static_cast<std::uint32_t>(which.count));
        in.faceOffsets[Slicer::faceCount(cursor)] = Slicer::indexCount(cursor);
        std::uint32_t* const to = in.indices + Slicer::indexCount(cursor);
        const std::uint16_t* const edges = in.tetraEdges[t].e;
        for (int k = 0; k < which.count; ++k)
            to[k] = in.edgePoints[edges[which.edge[std::size_t(k)]]] + surface;
    }
}

} // namespace core
} // namespace osgVolumizer
