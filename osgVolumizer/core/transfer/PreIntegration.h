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

/// A pre-integrated table: texel (front i, back j), front fastest, at values low +
/// i/(count-1)*(high-low).
struct PreIntegratedTable
{
    int count = 0;
    std::vector<glm::vec4> texels;
};

/// Mean extinction per unit (alpha) and mean extinction times colour (rgb) of a segment, whatever
/// its length: without self-attenuation the segment adds rgb/alpha * (1 - exp(-alpha*length)).
/// Engel, Kraus and Ertl, "High-Quality Pre-Integrated Volume Rendering Using Hardware-Accelerated
/// Pixel Shading", Graphics Hardware 2001. count >= 2, cost O(count^2).
OSGVOLUMIZER_CORE_EXPORT PreIntegratedTable preIntegrate(const TransferFunction& function,
                                                         int count, double low, double high);

/// Premultiplied colour and opacity of a segment `lengthUnits` long, attenuation within the segment
/// included (the same paper). Exact opacity; colour to 2e-5 from 33 texels on, for segments up to 5
/// units. Not symmetric: light from the front counts more. Cost O(count^2 (count + points)): up to
/// 256 at a change of table.
OSGVOLUMIZER_CORE_EXPORT PreIntegratedTable preIntegrateSegment(const TransferFunction& function,
                                                                int count, double low, double high,
                                                                double lengthUnits);

} // namespace core
} // namespace osgVolumizer
