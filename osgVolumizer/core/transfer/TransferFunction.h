#pragma once

#include "../Export.h"
#include "../Status.h"

#include <glm/vec4.hpp>

#include <vector>

namespace osgVolumizer {
namespace core {

/// Colour and opacity as piecewise linear functions of one value: linear between points, constant
/// beyond the first and last. Two points at one value make a jump; the later one holds from there
/// on. Colours are linear RGB, straight; opacity (alpha) is that of a layer one opacity unit thick.
class OSGVOLUMIZER_CORE_EXPORT TransferFunction
{
public:
    struct Point
    {
        double value = 0.0;
        glm::dvec4 color{0.0}; ///< RGBA, each in [0, 1]
    };

    /// A grey ramp from (0, transparent black) to (1, white, alpha 1).
    TransferFunction();
    /// Refuses (VALUE_INVALID, index of the first offender) an empty list, NaN or infinite numbers,
    /// components outside [0, 1] and values that decrease.
    static Result<TransferFunction> create(std::vector<Point> points);
    /// Entry i of n at value i/(n-1); one entry is a constant.
    static Result<TransferFunction> createUniform(const std::vector<glm::dvec4>& entries);

    const std::vector<Point>& points() const { return _points; }
    /// RGBA at a value; NaN gives transparent black.
    glm::dvec4 evaluate(double value) const;
    /// Largest opacity over the closed interval [low, high]; exact.
    double maximumOpacity(double low, double high) const;
    /// Smallest likewise; 0 where there is no interval.
    double minimumOpacity(double low, double high) const;
    /// Values mapped by value -> scale * value + offset, scale > 0.
    TransferFunction mapped(double scale, double offset) const;

    /// `count` texels that tabulate (r, g, b, extinction per opacity unit) over [low, high], texel
    /// i at low + (i + 0.5)/count * (high - low) when `texelCenters`, else at i/(count-1); count
    /// >= 2.
    std::vector<glm::vec4> tabulateExtinction(int count, double low, double high,
                                              bool texelCenters) const;

private:
    template <class Choose>
    double extremeOpacity(double low, double high, const Choose& choose) const;

    std::vector<Point> _points;
};

/// Extinction coefficient of a layer: -ln(1 - alpha), with alpha held at 1 - 2^-24 so that an
/// opaque entry stays finite (it lets 6e-8 of the light through per unit).
OSGVOLUMIZER_CORE_EXPORT double extinctionFromOpacity(double alpha);
/// Opacity of a segment: 1 - exp(-extinction * length).
OSGVOLUMIZER_CORE_EXPORT double opacityFromExtinction(double extinctionPerUnit, double lengthUnits);

} // namespace core
} // namespace osgVolumizer
