#include "SliceScan.h"

#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
#if defined(__GNUC__) && !defined(__clang__)
// GCC sees uninitialized values in its own header (its bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>

#define OSGVOLUMIZER_AVX512                                                                        \
    __attribute__((target("avx512f,avx512bw,avx512vl,avx512vbmi,avx512vnni,bmi,bmi2,popcnt")))

namespace osgVolumizer {
namespace core {
namespace avx512 {

namespace {

constexpr std::size_t READ_AHEAD = 1024; ///< bytes

/// A table of 256 bytes in four registers.
struct Table
{
    __m512i part[4];

    OSGVOLUMIZER_AVX512 explicit Table(const std::uint8_t* bytes)
    {
        for (int i = 0; i < 4; ++i)
            part[i] = _mm512_load_si512(bytes + 64 * i);
    }
    OSGVOLUMIZER_AVX512 __m512i operator[](__m512i index) const
    {
        return _mm512_mask_blend_epi8(_mm512_movepi8_mask(index),
                                      _mm512_permutex2var_epi8(part[0], index, part[1]),
                                      _mm512_permutex2var_epi8(part[2], index, part[3]));
    }
};

/// Per lane of 32 bits, the sum of the bytes of `bits` that are in the mask, plus `base`.
OSGVOLUMIZER_AVX512 inline __m512i addBits(__m512i base, __mmask64 mask, __m512i bits)
{
    return _mm512_dpbusd_epi32(base, _mm512_maskz_mov_epi8(mask, bits), _mm512_set1_epi8(1));
}

/// The sum of each of sixteen numbers and those before it.
OSGVOLUMIZER_AVX512 inline __m512i runningSum(__m512i n)
{
    const __m512i none = _mm512_setzero_si512();
    n = _mm512_add_epi32(n, _mm512_alignr_epi32(n, none, 15));
    n = _mm512_add_epi32(n, _mm512_alignr_epi32(n, none, 14));
    n = _mm512_add_epi32(n, _mm512_alignr_epi32(n, none, 12));
    return _mm512_add_epi32(n, _mm512_alignr_epi32(n, none, 8));
}

/// Half of 32 numbers of 16 bits, in 32 bits each.
OSGVOLUMIZER_AVX512 inline __m512i widen(__m512i v, int half)
{
    return _mm512_cvtepu16_epi32(half ? _mm512_extracti64x4_epi64(v, 1)
                                      : _mm512_castsi512_si256(v));
}

} // namespace

bool available()
{
    static const bool has =
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vbmi") &&
        __builtin_cpu_supports("avx512vnni") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("popcnt") && __builtin_cpu_supports("avx2");
    return has && instructionLimit() >= Instructions::AVX512;
}

OSGVOLUMIZER_AVX512 void packPassed(const int* passed, Slicer::Work& work)
{
    for (std::size_t i = 0; i < TetraBlocks::MAX_VERTICES; i += 16)
        _mm_store_si128(reinterpret_cast<__m128i*>(work.passedBytes.data() + i),
                        _mm512_cvtepi32_epi8(_mm512_loadu_si512(passed + i)));
}

OSGVOLUMIZER_AVX512 std::uint32_t listFaces(const TetraBlocks::Tetra* tetrahedra, std::uint32_t t,
                                            std::uint32_t end, const int* passed,
                                            Slicer::Work& work)
{
    const Table table(work.passedBytes.data());
    const __m512i bits = _mm512_set1_epi32(0x08040201), oneByte = _mm512_set1_epi8(1),
                  nextSurface = _mm512_set1_epi32(1 << 14), lowByte = _mm512_set1_epi32(0xff),
                  steps = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (; t + 16 <= end; t += 16) {
        __builtin_prefetch(tetrahedra + t + READ_AHEAD / sizeof(TetraBlocks::Tetra));
        // Four bytes per tetrahedron; the lowest and highest in all four.
        const __m512i v = table[_mm512_loadu_si512(tetrahedra + t)];
        const __m512i turned = _mm512_rol_epi32(v, 16);
        __m512i low = _mm512_min_epu8(v, turned), high = _mm512_max_epu8(v, turned);
        low = _mm512_min_epu8(low, _mm512_rol_epi32(low, 8));
        high = _mm512_max_epu8(high, _mm512_rol_epi32(high, 8));
        const __m512i n = _mm512_and_si512(_mm512_sub_epi8(high, low), lowByte);
        if (_mm512_cmpgt_epu32_mask(n, _mm512_set1_epi32(2))) {
            for (std::uint32_t i = t; i < t + 16; ++i)
                listFace(tetrahedra[i], i, passed, work);
            continue;
        }
        const __mmask16 one = _mm512_test_epi32_mask(n, n);
        const __mmask16 two = _mm512_cmpgt_epu32_mask(n, _mm512_set1_epi32(1));
        const __m512i number =
            _mm512_slli_epi32(_mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(t)), steps), 4);
        const __m512i base =
            _mm512_add_epi32(number, _mm512_slli_epi32(_mm512_and_si512(low, lowByte), 14));
        const __m512i first = addBits(base, _mm512_cmpgt_epu8_mask(v, low), bits);
        const __m512i second =
            addBits(_mm512_add_epi32(base, nextSurface),
                    _mm512_cmpgt_epu8_mask(v, _mm512_add_epi8(low, oneByte)), bits);
        growLarge(work.entries, work.entryCount + 48, work.entryCount);
        std::uint32_t* to = work.entries.data() + work.entryCount;
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(one, first));
        to += _mm_popcnt_u32(one);
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(two, second));
        to += _mm_popcnt_u32(two);
        work.entryCount = static_cast<std::size_t>(to - work.entries.data());
    }
    return t;
}

OSGVOLUMIZER_AVX512 std::uint32_t listPoints(const TetraBlocks::Edge* edges, std::uint32_t count,
                                             const int* passed, Slicer::Work& work)
{
    const Table table(work.passedBytes.data());
    const __m512i lowByte = _mm512_set1_epi16(0xff);
    const __m512i oneSurface = _mm512_set1_epi32(0x10000);
    // The first eight of two registers in turn, and the last eight.
    const __m512i lower = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    const __m512i upper = _mm512_add_epi32(lower, _mm512_set1_epi32(8));
    std::uint32_t i = 0;
    for (; i + 32 <= count; i += 32) {
        __builtin_prefetch(edges + i + READ_AHEAD / sizeof(TetraBlocks::Edge));
        const __m512i e = _mm512_loadu_si512(edges + i);
        const __m512i v = table[e];
        const __m512i passedA = _mm512_and_si512(v, lowByte), passedB = _mm512_srli_epi16(v, 8);
        const __m512i low16 = _mm512_min_epu16(passedA, passedB);
        const __m512i n16 = _mm512_sub_epi16(_mm512_max_epu16(passedA, passedB), low16);
        if (_mm512_cmpgt_epu16_mask(n16, _mm512_set1_epi16(2))) {
            for (std::uint32_t k = i; k < i + 32; ++k)
                listEdge(edges[k], k, passed, work);
            continue;
        }
        const __m512i swapped = _mm512_or_si512(_mm512_slli_epi16(e, 8), _mm512_srli_epi16(e, 8));
        const __m512i ends16 =
            _mm512_mask_blend_epi16(_mm512_cmpgt_epu16_mask(passedB, passedA), swapped, e);
        growLarge(work.points, work.pointCount + 96, work.pointCount);
        std::uint32_t* to = work.points.data() + work.pointCount;
        for (int half = 0; half < 2; ++half) {
            const __m512i n = widen(n16, half), low = widen(low16, half);
            const __m512i first = _mm512_or_si512(widen(ends16, half), _mm512_slli_epi32(low, 16));
            const __m512i second = _mm512_add_epi32(first, oneSurface);
            const __m512i before = _mm512_sub_epi32(runningSum(n), n);
            const auto number = static_cast<int>(work.vertexCount +
                                                 static_cast<std::size_t>(to - work.points.data()));
            _mm512_storeu_si512(
                work.edgePoints.data() + i + 16 * half,
                _mm512_sub_epi32(_mm512_add_epi32(before, _mm512_set1_epi32(number)), low));
            // Both points of each edge one after the other, those that there are moved together.
            const std::uint32_t has =
                _pdep_u32(_mm512_test_epi32_mask(n, n), 0x55555555u) |
                _pdep_u32(_mm512_cmpgt_epu32_mask(n, _mm512_set1_epi32(1)), 0xaaaaaaaau);
            _mm512_storeu_si512(
                to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(has),
                                                _mm512_permutex2var_epi32(first, lower, second)));
            to += _mm_popcnt_u32(has & 0xffffu);
            _mm512_storeu_si512(
                to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(has >> 16),
                                                _mm512_permutex2var_epi32(first, upper, second)));
            to += _mm_popcnt_u32(has >> 16);
        }
        work.pointCount = static_cast<std::size_t>(to - work.points.data());
    }
    return i;
}

OSGVOLUMIZER_AVX512 std::size_t weighPoints(const double* layers, int base, std::size_t count,
                                            std::uint32_t* points, double* weights)
{
    const __m256i byte = _mm256_set1_epi32(0xff);
    const __m512d origin = _mm512_set1_pd(base + 0.5), half = _mm512_set1_pd(0.5),
                  one = _mm512_set1_pd(1.0);
    std::size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        const __m256i p = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(points + i));
        const __m256i a = _mm256_and_si256(p, byte);
        const __m256i b = _mm256_and_si256(_mm256_srli_epi32(p, 8), byte);
        const __m512d farLayer = _mm512_i32gather_pd(a, layers, 8);
        const __m512d nearLayer = _mm512_i32gather_pd(b, layers, 8);
        const __m512d surface = _mm512_add_pd(_mm512_cvtepi32_pd(_mm256_srli_epi32(p, 16)), origin);
        const __m512d t =
            _mm512_div_pd(_mm512_sub_pd(surface, farLayer), _mm512_sub_pd(nearLayer, farLayer));
        const __mmask8 nearFar = _mm512_cmp_pd_mask(t, half, _CMP_LT_OQ);
        _mm512_storeu_pd(weights + i,
                         _mm512_mask_sub_pd(t, static_cast<__mmask8>(~nearFar), t, one));
        const __m256i nearest = _mm256_mask_blend_epi32(nearFar, b, a);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(points + i),
                            _mm256_or_si256(_mm256_and_si256(p, _mm256_set1_epi32(0xffff)),
                                            _mm256_slli_epi32(nearest, 16)));
    }
    return i;
}

} // namespace avx512
} // namespace core
} // namespace osgVolumizer
#endif
