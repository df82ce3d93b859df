#include "Slicer.h"

#include <algorithm>
#include <cstdlib>

#if defined(__x86_64__)
#include <immintrin.h>
#define OSGVOLUMIZER_AVX2 __attribute__((target("avx2")))
#endif

namespace osgVolumizer {
namespace core {

// Most tetrahedra and edges meet none, one or two surfaces of a lattice that is as fine as they
// are, and a branch on that number would be mispredicted half of the time. So two are always
// written, and the end of the list moves on by the number that counts.

namespace {

void reserveMore(std::vector<std::uint64_t>& list, std::size_t size)
{
    if (list.size() < size) list.resize(2 * size + 1024);
}

void listFace(const TetraBlocks::Tetra& v, std::uint32_t t, const int* passed, Slicer::Chunk& chunk)
{
    const int a = passed[v.v[0]], b = passed[v.v[1]], c = passed[v.v[2]], d = passed[v.v[3]];
    const int low = std::min(std::min(a, b), std::min(c, d));
    const auto n = static_cast<std::size_t>(std::max(std::max(a, b), std::max(c, d)) - low);
    const auto entry = [&](int k) {
        const unsigned mask =
            (a > k ? 1u : 0u) | (b > k ? 2u : 0u) | (c > k ? 4u : 0u) | (d > k ? 8u : 0u);
        return std::uint64_t(std::uint32_t(k)) << 32 | std::uint64_t(t) << 8 | mask;
    };
    reserveMore(chunk.entries, chunk.entryCount + n + 2);
    std::uint64_t* e = chunk.entries.data() + chunk.entryCount;
    e[0] = entry(low);
    e[1] = entry(low + 1);
    for (std::size_t k = 2; k < n; ++k)
        e[k] = entry(low + static_cast<int>(k));
    chunk.entryCount += n;
}

void listEdge(const TetraBlocks::Edge& e, std::uint32_t i, const int* passed, Slicer::Chunk& chunk)
{
    const int a = passed[e.a], b = passed[e.b];
    const int low = std::min(a, b);
    const auto n = static_cast<std::size_t>(std::max(a, b) - low);
    const std::uint64_t ends =
        a < b ? std::uint64_t(e.b) << 8 | e.a : std::uint64_t(e.a) << 8 | e.b;
    reserveMore(chunk.points, chunk.pointCount + n + 2);
    std::uint64_t* to = chunk.points.data() + chunk.pointCount;
    to[0] = std::uint64_t(std::uint32_t(low)) << 32 | ends;
    to[1] = std::uint64_t(std::uint32_t(low + 1)) << 32 | ends;
    for (std::size_t k = 2; k < n; ++k)
        to[k] = std::uint64_t(std::uint32_t(low) + k) << 32 | ends;
    chunk.edgePoints[i] =
        static_cast<std::uint32_t>(chunk.vertexCount + chunk.pointCount) - std::uint32_t(low);
    chunk.pointCount += n;
}

#if defined(__x86_64__)

/// Which of four numbers are greater than k, as bits.
OSGVOLUMIZER_AVX2 inline __m256i beyond(__m256i a, __m256i b, __m256i c, __m256i d, __m256i k)
{
    const __m256i ab =
        _mm256_or_si256(_mm256_and_si256(_mm256_cmpgt_epi32(a, k), _mm256_set1_epi32(1)),
                        _mm256_and_si256(_mm256_cmpgt_epi32(b, k), _mm256_set1_epi32(2)));
    const __m256i cd =
        _mm256_or_si256(_mm256_and_si256(_mm256_cmpgt_epi32(c, k), _mm256_set1_epi32(4)),
                        _mm256_and_si256(_mm256_cmpgt_epi32(d, k), _mm256_set1_epi32(8)));
    return _mm256_or_si256(ab, cd);
}

/// Writes eight pairs of numbers high << 32 | low, where pair j is (low0, high0)[j] and
/// (low1, high0 + 1)[j]; pair j goes to `to`, which then moves on by advance[j].
OSGVOLUMIZER_AVX2 inline std::uint64_t* writePairs(__m256i low0, __m256i low1, __m256i high,
                                                   __m256i advance, std::uint64_t* to)
{
    alignas(32) int n[8];
    _mm256_store_si256(reinterpret_cast<__m256i*>(n), advance);
    const __m256i next = _mm256_add_epi32(high, _mm256_set1_epi32(1));
    const __m256i first = _mm256_unpacklo_epi32(low0, high),
                  last = _mm256_unpackhi_epi32(low0, high);
    const __m256i first1 = _mm256_unpacklo_epi32(low1, next),
                  last1 = _mm256_unpackhi_epi32(low1, next);
    const __m256i pairs[4] = {
        _mm256_unpacklo_epi64(first, first1), _mm256_unpackhi_epi64(first, first1),
        _mm256_unpacklo_epi64(last, last1), _mm256_unpackhi_epi64(last, last1)};
    for (int j = 0; j < 4; ++j, to += n[j - 1])
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(pairs[j]));
    for (int j = 0; j < 4; ++j, to += n[j + 3])
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_extracti128_si256(pairs[j], 1));
    return to;
}

OSGVOLUMIZER_AVX2 void listFacesAvx2(const TetraBlocks::Tetra* tetrahedra, std::uint32_t t,
                                     std::uint32_t end, const int* passed, Slicer::Chunk& chunk)
{
    const __m256i byte = _mm256_set1_epi32(0xff);
    for (; t + 8 <= end; t += 8) {
        const __m256i v = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(tetrahedra + t));
        const __m256i a = _mm256_i32gather_epi32(passed, _mm256_and_si256(v, byte), 4);
        const __m256i b =
            _mm256_i32gather_epi32(passed, _mm256_and_si256(_mm256_srli_epi32(v, 8), byte), 4);
        const __m256i c =
            _mm256_i32gather_epi32(passed, _mm256_and_si256(_mm256_srli_epi32(v, 16), byte), 4);
        const __m256i d = _mm256_i32gather_epi32(passed, _mm256_srli_epi32(v, 24), 4);
        const __m256i low = _mm256_min_epi32(_mm256_min_epi32(a, b), _mm256_min_epi32(c, d));
        const __m256i high = _mm256_max_epi32(_mm256_max_epi32(a, b), _mm256_max_epi32(c, d));
        const __m256i n = _mm256_sub_epi32(high, low);
        if (_mm256_movemask_epi8(_mm256_cmpgt_epi32(n, _mm256_set1_epi32(2)))) {
            for (std::uint32_t i = t; i < t + 8; ++i)
                listFace(tetrahedra[i], i, passed, chunk);
            continue;
        }
        const __m256i number =
            _mm256_slli_epi32(_mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(t)),
                                               _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)),
                              8);
        const __m256i next = _mm256_add_epi32(low, _mm256_set1_epi32(1));
        reserveMore(chunk.entries, chunk.entryCount + 24);
        std::uint64_t* to = chunk.entries.data() + chunk.entryCount;
        chunk.entryCount += static_cast<std::size_t>(
            writePairs(_mm256_or_si256(number, beyond(a, b, c, d, low)),
                       _mm256_or_si256(number, beyond(a, b, c, d, next)), low, n, to) -
            to);
    }
    for (; t < end; ++t)
        listFace(tetrahedra[t], t, passed, chunk);
}

/// Loads eight edges and the numbers of surfaces that their ends have passed.
struct EightEdges
{
    __m256i a, b, passedA, passedB;

    OSGVOLUMIZER_AVX2 EightEdges(const TetraBlocks::Edge* edges, const int* passed)
    {
        const __m256i e =
            _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(edges)));
        a = _mm256_and_si256(e, _mm256_set1_epi32(0xff));
        b = _mm256_srli_epi32(e, 8);
        passedA = _mm256_i32gather_epi32(passed, a, 4);
        passedB = _mm256_i32gather_epi32(passed, b, 4);
    }
};

OSGVOLUMIZER_AVX2 std::size_t countPointsAvx2(const TetraBlocks::Edge* edges, std::uint32_t count,
                                              const int* passed)
{
    // Eight sums of 32 bits: a block has few thousand edges, so 2^19 surfaces fit.
    __m256i sum = _mm256_setzero_si256();
    std::size_t r = 0;
    std::uint32_t i = 0;
    for (; i + 8 <= count; i += 8) {
        const EightEdges e(edges + i, passed);
        const __m256i n = _mm256_abs_epi32(_mm256_sub_epi32(e.passedA, e.passedB));
        sum = _mm256_add_epi64(
            sum, _mm256_add_epi64(_mm256_srli_epi64(n, 32),
                                  _mm256_and_si256(n, _mm256_set1_epi64x(0xffffffff))));
    }
    alignas(32) std::uint64_t parts[4];
    _mm256_store_si256(reinterpret_cast<__m256i*>(parts), sum);
    for (const std::uint64_t part : parts)
        r += part;
    for (; i < count; ++i)
        r += static_cast<std::size_t>(std::abs(passed[edges[i].a] - passed[edges[i].b]));
    return r;
}

OSGVOLUMIZER_AVX2 void listPointsAvx2(const TetraBlocks::Edge* edges, std::uint32_t count,
                                      const int* passed, Slicer::Chunk& chunk)
{
    std::uint32_t i = 0;
    for (; i + 8 <= count; i += 8) {
        const EightEdges e(edges + i, passed);
        const __m256i low = _mm256_min_epi32(e.passedA, e.passedB);
        const __m256i n = _mm256_sub_epi32(_mm256_max_epi32(e.passedA, e.passedB), low);
        if (_mm256_movemask_epi8(_mm256_cmpgt_epi32(n, _mm256_set1_epi32(2)))) {
            for (std::uint32_t k = i; k < i + 8; ++k)
                listEdge(edges[k], k, passed, chunk);
            continue;
        }
        const __m256i up = _mm256_cmpgt_epi32(e.passedB, e.passedA);
        const __m256i farEnd = _mm256_blendv_epi8(e.b, e.a, up);
        const __m256i nearEnd = _mm256_blendv_epi8(e.a, e.b, up);
        const __m256i ends = _mm256_or_si256(farEnd, _mm256_slli_epi32(nearEnd, 8));
        // Points before each edge: a prefix sum in halves of four, then across.
        __m256i sum = _mm256_add_epi32(n, _mm256_slli_si256(n, 4));
        sum = _mm256_add_epi32(sum, _mm256_slli_si256(sum, 8));
        const __m256i lowerTotal = _mm256_permutevar8x32_epi32(sum, _mm256_set1_epi32(3));
        sum = _mm256_add_epi32(sum, _mm256_blend_epi32(_mm256_setzero_si256(), lowerTotal, 0xf0));
        const __m256i before = _mm256_sub_epi32(sum, n);
        const auto first = static_cast<int>(chunk.vertexCount + chunk.pointCount);
        _mm256_storeu_si256(
            reinterpret_cast<__m256i*>(chunk.edgePoints.data() + i),
            _mm256_sub_epi32(_mm256_add_epi32(before, _mm256_set1_epi32(first)), low));
        reserveMore(chunk.points, chunk.pointCount + 24);
        std::uint64_t* to = chunk.points.data() + chunk.pointCount;
        chunk.pointCount += static_cast<std::size_t>(writePairs(ends, ends, low, n, to) - to);
    }
    for (; i < count; ++i)
        listEdge(edges[i], i, passed, chunk);
}

bool hasAvx2()
{
    static const bool has = __builtin_cpu_supports("avx2");
    return has;
}

#endif

} // namespace

void listFaces(const TetraBlocks::Tetra* tetrahedra, std::uint32_t first, std::uint32_t count,
               const int* passed, Slicer::Chunk& chunk)
{
#if defined(__x86_64__)
    if (hasAvx2()) {
        listFacesAvx2(tetrahedra, first, first + count, passed, chunk);
        return;
    }
#endif
    for (std::uint32_t t = first; t < first + count; ++t)
        listFace(tetrahedra[t], t, passed, chunk);
}

std::size_t countPoints(const TetraBlocks::Edge* edges, std::uint32_t count, const int* passed)
{
#if defined(__x86_64__)
    if (hasAvx2()) return countPointsAvx2(edges, count, passed);
#endif
    std::size_t r = 0;
    for (std::uint32_t i = 0; i < count; ++i)
        r += static_cast<std::size_t>(std::abs(passed[edges[i].a] - passed[edges[i].b]));
    return r;
}

void listPoints(const TetraBlocks::Edge* edges, std::uint32_t count, const int* passed,
                Slicer::Chunk& chunk)
{
    if (chunk.edgePoints.size() < count) chunk.edgePoints.resize(count);
    chunk.pointCount = 0;
#if defined(__x86_64__)
    if (hasAvx2()) {
        listPointsAvx2(edges, count, passed, chunk);
        return;
    }
#endif
    for (std::uint32_t i = 0; i < count; ++i)
        listEdge(edges[i], i, passed, chunk);
}

} // namespace core
} // namespace osgVolumizer
