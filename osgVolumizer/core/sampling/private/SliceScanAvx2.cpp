#include "SliceScan.h"

#include "TetraCases.h"

#include <array>
#include <cstring>

#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
#include <immintrin.h>

namespace osgVolumizer {
namespace core {
namespace avx2 {

namespace {

// How far ahead of their use memory is asked for, in bytes.
constexpr std::size_t READ_AHEAD = 1024, WRITE_AHEAD = 256;

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

/// The sum of each of eight numbers and those before it.
OSGVOLUMIZER_AVX2 inline __m256i runningSum(__m256i n)
{
    __m256i sum = _mm256_add_epi32(n, _mm256_slli_si256(n, 4));
    sum = _mm256_add_epi32(sum, _mm256_slli_si256(sum, 8));
    const __m256i lower = _mm256_permutevar8x32_epi32(sum, _mm256_set1_epi32(3));
    return _mm256_add_epi32(sum, _mm256_blend_epi32(_mm256_setzero_si256(), lower, 0xf0));
}

/// Writes the upper half, anywhere: _mm_storeh_pd() is declared to need the alignment of a double.
OSGVOLUMIZER_AVX2 inline void storeUpper(std::uint32_t* to, __m128i v)
{
    const long long upper = _mm_extract_epi64(v, 1);
    std::memcpy(to, &upper, sizeof(upper));
}

/// Writes eight pairs of numbers, pair j to to[before[j]].
OSGVOLUMIZER_AVX2 inline void writePairs(__m256i first, __m256i second, __m256i before,
                                         std::uint32_t* to)
{
    alignas(32) std::uint32_t at[8];
    _mm256_store_si256(reinterpret_cast<__m256i*>(at), before);
    const __m256i low = _mm256_unpacklo_epi32(first, second);
    const __m256i high = _mm256_unpackhi_epi32(first, second);
    const __m128i pairs[4] = {_mm256_castsi256_si128(low), _mm256_castsi256_si128(high),
                              _mm256_extracti128_si256(low, 1), _mm256_extracti128_si256(high, 1)};
    for (int j = 0; j < 4; ++j) {
        _mm_storel_epi64(reinterpret_cast<__m128i*>(to + at[2 * j]), pairs[j]);
        storeUpper(to + at[2 * j + 1], pairs[j]);
    }
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

/// Per case, the bytes of TetraEdges that make four numbers of 32 bits: the edges of the first two
/// corners, then those of the last two.
struct alignas(16) CornerBytes
{
    std::uint8_t byte[16];
};
constexpr std::array<CornerBytes, 16> CORNER_BYTES = [] {
    std::array<CornerBytes, 16> table{};
    for (std::size_t mask = 0; mask < 16; ++mask) {
        const TetraCase& c = TETRA_CASES[mask];
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t corner = k < 2 || c.count == 4 ? k : k - 1;
            std::uint8_t* byte = table[mask].byte + 4 * k;
            byte[0] = static_cast<std::uint8_t>(2 * c.edge[corner]);
            byte[1] = static_cast<std::uint8_t>(2 * c.edge[corner] + 1);
            byte[2] = byte[3] = 0x80; // zero
        }
    }
    return table;
}();

template <bool Places>
OSGVOLUMIZER_AVX2 void emit(const Emission& in)
{
    // All that the loop needs is in local variables, since the compiler has to expect that its
    // stores change anything else.
    const TetraBlocks::TetraEdges* const tetraEdges = in.tetraEdges;
    const TetraBlocks::Place* const places = in.places;
    const int* const edgePoints = reinterpret_cast<const int*>(in.edgePoints);
    const std::size_t brickCount = in.brickCount;
    Slicer::Count* const cursors = in.cursors;
    std::uint32_t *const indices = in.indices, *const faceOffsets = in.faceOffsets;
    const std::uint32_t* const end = in.endEntries;
    for (const std::uint32_t* entry = in.entries; entry != end; ++entry) {
        const std::uint32_t e = *entry, t = e >> 4 & 0x3ffu;
        const std::size_t surface = e >> 14, which = e & 15u;
        __builtin_prefetch(tetraEdges + t + READ_AHEAD / sizeof(TetraBlocks::TetraEdges));
        const __m128i edges = _mm_shuffle_epi8(
            _mm_loadu_si128(reinterpret_cast<const __m128i*>(tetraEdges + t)),
            _mm_load_si128(reinterpret_cast<const __m128i*>(&CORNER_BYTES[which])));
        const __m128i corners = _mm_add_epi32(_mm_i32gather_epi32(edgePoints, edges, 4),
                                              _mm_set1_epi32(static_cast<int>(surface)));
        std::size_t bin = surface * brickCount;
        if (Places) bin += places[t] & TetraBlocks::BOX_MASK;
        const Slicer::Count cursor = cursors[bin], next = cursor + FACE_COUNTS[which];
        cursors[bin] = next;
        faceOffsets[Slicer::faceCount(cursor)] = Slicer::indexCount(cursor);
        __builtin_prefetch(
            indices + Slicer::indexCount(cursor) + WRITE_AHEAD / sizeof(std::uint32_t), 1);
        __builtin_prefetch(faceOffsets + Slicer::faceCount(cursor) + 32, 1);
        _mm_storel_epi64(reinterpret_cast<__m128i*>(indices + Slicer::indexCount(cursor)), corners);
        storeUpper(indices + Slicer::indexCount(next) - 2, corners);
    }
}

} // namespace

bool available()
{
    static const bool has = __builtin_cpu_supports("avx2");
    return has && instructionLimit() >= Instructions::AVX2;
}

OSGVOLUMIZER_AVX2 PassedRange listLayers(const SlicePlan& plan, const double* record,
                                         std::size_t stride, std::uint32_t count, int base, int end,
                                         double* layers, int* passed)
{
    const double* field = record + plan.depthField;
    const __m256d gx = _mm256_set1_pd(plan.gradient.x), gy = _mm256_set1_pd(plan.gradient.y),
                  gz = _mm256_set1_pd(plan.gradient.z), cx = _mm256_set1_pd(plan.corner.x),
                  cy = _mm256_set1_pd(plan.corner.y), cz = _mm256_set1_pd(plan.corner.z),
                  farDepth = _mm256_set1_pd(plan.lattice.farDepth),
                  scale = _mm256_set1_pd(1.0 / plan.lattice.spacing), first = _mm256_set1_pd(base),
                  last = _mm256_set1_pd(end), half = _mm256_set1_pd(0.5);
    const __m128i base4 = _mm_set1_epi32(base);
    __m128i lowest = _mm_set1_epi32(end - base), highest = _mm_setzero_si128();
    std::uint32_t i = 0;
    for (; i + 4 <= count; i += 4, field += 4 * stride) {
        __builtin_prefetch(field + READ_AHEAD / sizeof(double));
        // Four positions and whatever follows them, transposed.
        const __m256d p = _mm256_loadu_pd(field), q = _mm256_loadu_pd(field + stride),
                      r = _mm256_loadu_pd(field + 2 * stride),
                      s = _mm256_loadu_pd(field + 3 * stride);
        const __m256d pq = _mm256_unpacklo_pd(p, q), rs = _mm256_unpacklo_pd(r, s);
        const __m256d x = _mm256_permute2f128_pd(pq, rs, 0x20);
        const __m256d z = _mm256_permute2f128_pd(pq, rs, 0x31);
        const __m256d y =
            _mm256_permute2f128_pd(_mm256_unpackhi_pd(p, q), _mm256_unpackhi_pd(r, s), 0x20);
        const __m256d depth = _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(gx, _mm256_sub_pd(x, cx)),
                                                          _mm256_mul_pd(gy, _mm256_sub_pd(y, cy))),
                                            _mm256_mul_pd(gz, _mm256_sub_pd(z, cz)));
        const __m256d layer = _mm256_mul_pd(_mm256_sub_pd(farDepth, depth), scale);
        _mm256_storeu_pd(layers + i, layer);
        // surfacesPassed()
        const __m256d g = _mm256_min_pd(_mm256_max_pd(_mm256_sub_pd(layer, half), first), last);
        const __m256d n = _mm256_ceil_pd(g);
        const __m128i k = _mm_sub_epi32(_mm256_cvttpd_epi32(n), base4);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(passed + i), k);
        lowest = _mm_min_epi32(lowest, k);
        highest = _mm_max_epi32(highest, k);
    }
    alignas(16) int low[4], high[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(low), lowest);
    _mm_store_si128(reinterpret_cast<__m128i*>(high), highest);
    PassedRange range{low[0], high[0]};
    for (int k = 1; k < 4; ++k) {
        range.lowest = low[k] < range.lowest ? low[k] : range.lowest;
        range.highest = high[k] > range.highest ? high[k] : range.highest;
    }
    for (; i < count; ++i)
        listLayer(plan, Slicer::depthOf(plan, record + i * stride, 0), base, end, layers[i],
                  passed[i], range);
    return range;
}

OSGVOLUMIZER_AVX2 void listFaces(const TetraBlocks::Tetra* tetrahedra, std::uint32_t t,
                                 std::uint32_t end, const int* passed, Slicer::Work& work)
{
    const __m256i byte = _mm256_set1_epi32(0xff);
    for (; t + 8 <= end; t += 8) {
        const __m256i v = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(tetrahedra + t));
        __builtin_prefetch(tetrahedra + t + READ_AHEAD / sizeof(TetraBlocks::Tetra));
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
                listFace(tetrahedra[i], i, passed, work);
            continue;
        }
        const __m256i number =
            _mm256_slli_epi32(_mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(t)),
                                               _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)),
                              4);
        const __m256i next = _mm256_add_epi32(low, _mm256_set1_epi32(1));
        const __m256i first = _mm256_or_si256(_mm256_or_si256(number, _mm256_slli_epi32(low, 14)),
                                              beyond(a, b, c, d, low));
        const __m256i second = _mm256_or_si256(_mm256_or_si256(number, _mm256_slli_epi32(next, 14)),
                                               beyond(a, b, c, d, next));
        growLarge(work.entries, work.entryCount + 24, work.entryCount);
        const __m256i sum = runningSum(n);
        writePairs(first, second, _mm256_sub_epi32(sum, n), work.entries.data() + work.entryCount);
        work.entryCount += static_cast<std::uint32_t>(_mm256_extract_epi32(sum, 7));
    }
    for (; t < end; ++t)
        listFace(tetrahedra[t], t, passed, work);
}

OSGVOLUMIZER_AVX2 void listPoints(const TetraBlocks::Edge* edges, std::uint32_t count,
                                  const int* passed, Slicer::Work& work)
{
    std::uint32_t i = 0;
    for (; i + 8 <= count; i += 8) {
        __builtin_prefetch(edges + i + READ_AHEAD / sizeof(TetraBlocks::Edge));
        const EightEdges e(edges + i, passed);
        const __m256i low = _mm256_min_epi32(e.passedA, e.passedB);
        const __m256i n = _mm256_sub_epi32(_mm256_max_epi32(e.passedA, e.passedB), low);
        if (_mm256_movemask_epi8(_mm256_cmpgt_epi32(n, _mm256_set1_epi32(2)))) {
            for (std::uint32_t k = i; k < i + 8; ++k)
                listEdge(edges[k], k, passed, work);
            continue;
        }
        const __m256i up = _mm256_cmpgt_epi32(e.passedB, e.passedA);
        const __m256i farEnd = _mm256_blendv_epi8(e.b, e.a, up);
        const __m256i nearEnd = _mm256_blendv_epi8(e.a, e.b, up);
        const __m256i point = _mm256_or_si256(
            _mm256_or_si256(farEnd, _mm256_slli_epi32(nearEnd, 8)), _mm256_slli_epi32(low, 16));
        const __m256i sum = runningSum(n);
        const __m256i before = _mm256_sub_epi32(sum, n);
        const auto first = static_cast<int>(work.vertexCount + work.pointCount);
        _mm256_storeu_si256(
            reinterpret_cast<__m256i*>(work.edgePoints.data() + i),
            _mm256_sub_epi32(_mm256_add_epi32(before, _mm256_set1_epi32(first)), low));
        growLarge(work.points, work.pointCount + 24, work.pointCount);
        writePairs(point, _mm256_add_epi32(point, _mm256_set1_epi32(0x10000)), before,
                   work.points.data() + work.pointCount);
        work.pointCount += static_cast<std::uint32_t>(_mm256_extract_epi32(sum, 7));
    }
    for (; i < count; ++i)
        listEdge(edges[i], i, passed, work);
}

OSGVOLUMIZER_AVX2 void weighPoints(const double* layers, int base, std::size_t count,
                                   std::uint32_t* points, double* weights)
{
    const __m128i byte = _mm_set1_epi32(0xff);
    const __m256d origin = _mm256_set1_pd(base + 0.5), half = _mm256_set1_pd(0.5),
                  one = _mm256_set1_pd(1.0), none = _mm256_setzero_pd(),
                  all = _mm256_cmp_pd(none, none, _CMP_EQ_OQ);
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        __m128i* const at = reinterpret_cast<__m128i*>(points + i);
        const __m128i p = _mm_loadu_si128(at);
        const __m128i a = _mm_and_si128(p, byte), b = _mm_and_si128(_mm_srli_epi32(p, 8), byte);
        // With all lanes asked for; the form without a mask starts from an undefined value.
        const __m256d farLayer = _mm256_mask_i32gather_pd(none, layers, a, all, 8);
        const __m256d nearLayer = _mm256_mask_i32gather_pd(none, layers, b, all, 8);
        const __m256d surface = _mm256_add_pd(_mm256_cvtepi32_pd(_mm_srli_epi32(p, 16)), origin);
        const __m256d t =
            _mm256_div_pd(_mm256_sub_pd(surface, farLayer), _mm256_sub_pd(nearLayer, farLayer));
        const __m256d nearFar = _mm256_cmp_pd(t, half, _CMP_LT_OQ);
        _mm256_storeu_pd(weights + i, _mm256_blendv_pd(_mm256_sub_pd(t, one), t, nearFar));
        const __m128i which = _mm_castps_si128(
            _mm_shuffle_ps(_mm_castpd_ps(_mm256_castpd256_pd128(nearFar)),
                           _mm_castpd_ps(_mm256_extractf128_pd(nearFar, 1)), 0x88));
        const __m128i nearest = _mm_blendv_epi8(b, a, which);
        _mm_storeu_si128(at, _mm_or_si128(_mm_and_si128(p, _mm_set1_epi32(0xffff)),
                                          _mm_slli_epi32(nearest, 16)));
    }
    for (; i < count; ++i)
        weighPoint(layers, base, points[i], weights[i]);
}

void emitFaces(const Emission& emission)
{
    if (emission.places)
        emit<true>(emission);
    else
        emit<false>(emission);
}

} // namespace avx2
} // namespace core
} // namespace osgVolumizer
#endif
