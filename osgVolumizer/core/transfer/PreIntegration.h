#pragma once

#include "TransferFunction.h"

#include <vector>

namespace osgVolumizer {
namespace core {

/// Integrals of a transfer function along the value axis, from which a segment on which the value
/// runs linearly from one end to the other follows in closed form. Opacity is linear between
/// points, so the extinction is -ln(1 - alpha) and its integral, and that of extinction times
/// colour, are elementary: exact for every transfer function, jumps and opaque points included.
class OSGVOLUMIZER_CORE_EXPORT TransferIntegral
{
public:
    explicit TransferIntegral(const TransferFunction& function);

    /// Means over the values between `front` and `back` (either order): extinction per opacity unit
    /// in alpha, extinction times colour in rgb. For front == back, the values there.
    glm::dvec4 mean(double front, double back) const;

    /// Integrals from the first to each of `count` values at low + i/(count-1)*(high-low), counted
    /// in steps between them: a difference of two over the difference of their indices is mean().
    /// count >= 2, low < high. Cost O(count + points).
    std::vector<glm::dvec4> tabulate(int count, double low, double high) const;

private:
    /// Antiderivative, zero at the first point.
    glm::dvec4 integral(double value) const;

    TransferFunction _function;
    std::vector<glm::dvec4> _atPoint; ///< antiderivative at each point
};

/// See windowError().
struct WindowError
{
    double error = 0.0;
    double value = 0.0; ///< where
};

/// Largest difference, in the components of premultiplied colour and opacity of one unit, between
/// the function at a value and its mean over `width` about that value, both in [low, high]. What
/// one sample misses of a segment on which the value changes by `width`. Sampled at eight values a
/// width, and at the function's points. Cost O(points + (high - low)/width).
OSGVOLUMIZER_CORE_EXPORT WindowError windowError(const TransferFunction& function, double low,
                                                 double high, double width);

} // namespace core
} // namespace osgVolumizer
