#include "Interpolate.h"
#include "Slicer.h"

#include <cstring>

// Vector types of GCC and Clang: four doubles, in one register or two, whatever the target has. The
// same IEEE operations in the same order give the same bits either way.
#define OSGVOLUMIZER_INLINE inline __attribute__((always_inline))
#if defined(__x86_64__) && !defined(__AVX2__)
#define OSGVOLUMIZER_DISPATCH_AVX2 1
#endif

namespace osgVolumizer {
namespace core {

namespace {

using Double4 = double __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));

/// Four values of interpolate(), to single precision.
OSGVOLUMIZER_INLINE void interpolate4(float* to, const double* a, const double* b,
                                      const double* nearest, double weight, std::size_t bytes)
{
    Double4 p, q, n;
    std::memcpy(&p, a, sizeof p);
    std::memcpy(&q, b, sizeof q);
    std::memcpy(&n, nearest, sizeof n);
    const Float4 r = __builtin_convertvector(n + weight * (q - p), Float4);
    std::memcpy(to, &r, bytes);
}

/// S values per record, or any number where S is 0.
template <int S>
OSGVOLUMIZER_INLINE void writeAll(const double* records, std::size_t stride,
                                  const std::uint64_t* points, std::size_t count, float* to)
{
    for (std::size_t i = 0; i < count; ++i, to += stride) {
        const std::uint64_t point = points[i];
        const double* a = records + (stride + 1) * (point & 0xffu);
        const double* b = records + (stride + 1) * (point >> 8 & 0xffu);
        const double surface = static_cast<int>(point >> 32) + 0.5;
        const double t = (surface - a[stride]) / (b[stride] - a[stride]);
        const Between between(a, b, t);
        const double* nearest = between.nearest;
        const double weight = between.weight;
        if constexpr (S == 3) {
            // The fourth value is overwritten by the next point, but not at the end.
            if (i + 1 < count)
                interpolate4(to, a, b, nearest, weight, 16);
            else
                interpolate4(to, a, b, nearest, weight, 12);
        } else if constexpr (S > 3) {
            // The last group of four starts at S - 4, so that none is written beyond the record.
            for (int k = 0; k < S; k += 4) {
                const int at = k + 4 > S ? S - 4 : k;
                interpolate4(to + at, a + at, b + at, nearest + at, weight, 16);
            }
        } else {
            for (std::size_t k = 0; k < stride; ++k)
                to[k] = static_cast<float>(nearest[k] + weight * (b[k] - a[k]));
        }
    }
}

OSGVOLUMIZER_INLINE void writeAny(const double* records, std::size_t stride,
                                  const std::uint64_t* points, std::size_t count, float* to)
{
    switch (stride) {
    case 3:
        writeAll<3>(records, 3, points, count, to);
        break;
    case 6:
        writeAll<6>(records, 6, points, count, to);
        break;
    case 7:
        writeAll<7>(records, 7, points, count, to);
        break;
    case 9:
        writeAll<9>(records, 9, points, count, to);
        break;
    case 10:
        writeAll<10>(records, 10, points, count, to);
        break;
    default:
        writeAll<0>(records, stride, points, count, to);
        break;
    }
}

#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
__attribute__((target("avx2"))) void writeAvx2(const double* records, std::size_t stride,
                                               const std::uint64_t* points, std::size_t count,
                                               float* to)
{
    writeAny(records, stride, points, count, to);
}
#endif

void writeBaseline(const double* records, std::size_t stride, const std::uint64_t* points,
                   std::size_t count, float* to)
{
    writeAny(records, stride, points, count, to);
}

} // namespace

void writePoints(const TetraBlocks& blocks, const TetraBlocks::Block& block,
                 const Slicer::Chunk& chunk, float* to)
{
    const double* records = blocks.record(block.firstVertex);
    const std::size_t stride = blocks.recordSize() - 1;
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    static const bool avx2 = __builtin_cpu_supports("avx2");
    if (avx2) {
        writeAvx2(records, stride, chunk.points.data(), chunk.pointCount, to);
        return;
    }
#endif
    writeBaseline(records, stride, chunk.points.data(), chunk.pointCount, to);
}

} // namespace core
} // namespace osgVolumizer
