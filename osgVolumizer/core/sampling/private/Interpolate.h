#pragma once

#include <cstddef>

namespace osgVolumizer {
namespace core {

/// A point on the way from p (t = 0) to q (t = 1), as nearest + weight * (q - p), measured from the
/// nearer end. It is exact at both ends and, in floating point, never beyond them: with |weight| <=
/// 1/2 the product is at most half the rounded difference, so the exact sum lies between p and q,
/// and rounding is monotone. Plain p + t * (q - p) may overshoot q by a rounding error, and then a
/// polygon that ends on a clip plane would be cut by it.
struct Between
{
    const double* nearest;
    double weight;

    Between(const double* p, const double* q, double t)
        : nearest(t < 0.5 ? p : q), weight(t < 0.5 ? t : t - 1.0)
    {
    }
};

/// Interpolates `count` values.
inline void interpolate(const double* p, const double* q, double t, std::size_t count, double* out)
{
    const Between b(p, q, t);
    for (std::size_t k = 0; k < count; ++k)
        out[k] = b.nearest[k] + b.weight * (q[k] - p[k]);
}

} // namespace core
} // namespace osgVolumizer
