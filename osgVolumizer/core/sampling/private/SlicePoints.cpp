#include "Interpolate.h"
#include "SliceScan.h"

#include <cstring>

// Vector types of GCC and Clang: four doubles, in one register or two, whatever the target has. The
// same IEEE operations in the same order give the same bits either way.
#define OSGVOLUMIZER_INLINE inline __attribute__((always_inline))

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

/// One point of S values, or of any number where S is 0. Where ROOM, four may be written for three.
template <int S, bool ROOM>
OSGVOLUMIZER_INLINE void writeOne(const double* records, std::size_t size, std::uint32_t point,
                                  double weight, float* to)
{
    const double* a = records + size * (point & 0xffu);
    const double* b = records + size * (point >> 8 & 0xffu);
    const double* nearest = records + size * (point >> 16);
    if constexpr (S == 3) {
        interpolate4(to, a, b, nearest, weight, ROOM ? 16 : 12);
    } else if constexpr (S > 3) {
        // The last group of four starts at S - 4, so that none is written beyond the record.
        for (int k = 0; k < S; k += 4) {
            const int at = k + 4 > S ? S - 4 : k;
            interpolate4(to + at, a + at, b + at, nearest + at, weight, 16);
        }
    } else {
        for (std::size_t k = 0; k < size; ++k)
            to[k] = static_cast<float>(nearest[k] + weight * (b[k] - a[k]));
    }
}

/// Points as weighPoint() leaves them.
template <int S>
OSGVOLUMIZER_INLINE void writeAll(const double* records, std::size_t stride,
                                  const std::uint32_t* points, const double* weights,
                                  std::size_t count, float* to)
{
    if (count == 0) return;
    const std::size_t size = S == 0 ? stride : S;
    // A fourth value is overwritten by the next point; the last has none.
    for (std::size_t i = 0; i + 1 < count; ++i, to += size)
        writeOne<S, true>(records, size, points[i], weights[i], to);
    writeOne<S, false>(records, size, points[count - 1], weights[count - 1], to);
}

OSGVOLUMIZER_INLINE void writeAny(const double* records, std::size_t stride,
                                  const std::uint32_t* points, const double* weights,
                                  std::size_t count, float* to)
{
    switch (stride) {
    case 3:
        writeAll<3>(records, 3, points, weights, count, to);
        break;
    case 6:
        writeAll<6>(records, 6, points, weights, count, to);
        break;
    case 7:
        writeAll<7>(records, 7, points, weights, count, to);
        break;
    case 9:
        writeAll<9>(records, 9, points, weights, count, to);
        break;
    case 10:
        writeAll<10>(records, 10, points, weights, count, to);
        break;
    default:
        writeAll<0>(records, stride, points, weights, count, to);
        break;
    }
}

#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
OSGVOLUMIZER_AVX2 void writeAvx2(const double* records, std::size_t stride,
                                 const std::uint32_t* points, const double* weights,
                                 std::size_t count, float* to)
{
    writeAny(records, stride, points, weights, count, to);
}
#endif

void writeBaseline(const double* records, std::size_t stride, const std::uint32_t* points,
                   const double* weights, std::size_t count, float* to)
{
    writeAny(records, stride, points, weights, count, to);
}

} // namespace

void writePoints(const TetraBlocks& blocks, const TetraBlocks::Block& block, const double* layers,
                 int base, Slicer::Work& work, float* to)
{
    const double* records = blocks.record(block.firstVertex);
    const std::size_t stride = blocks.recordSize(), count = work.pointCount;
    growLarge(work.weights, count);
    std::uint32_t* const points = work.points.data();
    double* const weights = work.weights.data();
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    if (avx2::available()) {
        const std::size_t done =
            avx512::available() ? avx512::weighPoints(layers, base, count, points, weights) : 0;
        avx2::weighPoints(layers, base, count - done, points + done, weights + done);
        writeAvx2(records, stride, points, weights, count, to);
        return;
    }
#endif
    for (std::size_t i = 0; i < count; ++i)
        weighPoint(layers, base, points[i], weights[i]);
    writeBaseline(records, stride, points, weights, count, to);
}

} // namespace core
} // namespace osgVolumizer
