#include "TransferFunction.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

/// Where the image of a point is held, so that it is a number.
constexpr double FARTHEST = 1e300;

Status checkPoint(const TransferFunction::Point& point, std::int64_t index)
{
    const std::string where = "transfer function point " + std::to_string(index);
    if (!std::isfinite(point.value))
        return {ErrorCode::VALUE_INVALID, where + " has the value " + std::to_string(point.value),
                index};
    for (int c = 0; c < 4; ++c)
        if (!(point.color[c] >= 0.0 && point.color[c] <= 1.0))
            return {ErrorCode::VALUE_INVALID,
                    where + " has " + "rgba"[c] + " = " + std::to_string(point.color[c]) +
                        ", outside [0, 1]",
                    index};
    return {};
}

} // namespace

TransferFunction::TransferFunction() : _points{{0.0, glm::dvec4(0.0)}, {1.0, glm::dvec4(1.0)}} {}

Result<TransferFunction> TransferFunction::create(std::vector<Point> points)
{
    if (points.empty())
        return Status(ErrorCode::VALUE_INVALID, "a transfer function needs at least one point", 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto index = static_cast<std::int64_t>(i);
        if (Status status = checkPoint(points[i], index); !status.ok()) return status;
        if (i > 0 && points[i].value < points[i - 1].value)
            return Status(ErrorCode::VALUE_INVALID,
                          "transfer function point " + std::to_string(i) + " has the value " +
                              std::to_string(points[i].value) + ", below that of the one before, " +
                              std::to_string(points[i - 1].value),
                          index);
    }
    TransferFunction function;
    function._points = std::move(points);
    return function;
}

Result<TransferFunction> TransferFunction::createUniform(const std::vector<glm::dvec4>& entries)
{
    std::vector<Point> points(entries.size());
    const double last = entries.size() > 1 ? static_cast<double>(entries.size() - 1) : 1.0;
    for (std::size_t i = 0; i < entries.size(); ++i)
        points[i] = {static_cast<double>(i) / last, entries[i]};
    return create(std::move(points));
}

glm::dvec4 TransferFunction::evaluate(double value) const
{
    if (std::isnan(value)) return glm::dvec4(0.0);
    const auto after = std::upper_bound(_points.begin(), _points.end(), value,
                                        [](double v, const Point& p) { return v < p.value; });
    if (after == _points.begin()) return _points.front().color;
    if (after == _points.end()) return _points.back().color;
    const Point& a = *(after - 1);
    // Halves, because the distance of two finite values may overflow.
    const double t = (0.5 * value - 0.5 * a.value) / (0.5 * after->value - 0.5 * a.value);
    return (1.0 - t) * a.color + t * after->color;
}

// Piecewise linear: attained at an end, or at a point between.
template <class Choose>
double TransferFunction::extremeOpacity(double low, double high, const Choose& choose) const
{
    if (!(low <= high)) return 0.0;
    double extreme = choose(evaluate(low).a, evaluate(high).a);
    const auto byValue = [](const Point& p, double v) { return p.value < v; };
    for (auto p = std::lower_bound(_points.begin(), _points.end(), low, byValue);
         p != _points.end() && p->value <= high; ++p)
        extreme = choose(extreme, p->color.a);
    return extreme;
}

double TransferFunction::maximumOpacity(double low, double high) const
{
    return extremeOpacity(low, high, [](double a, double b) { return std::max(a, b); });
}

double TransferFunction::minimumOpacity(double low, double high) const
{
    return extremeOpacity(low, high, [](double a, double b) { return std::min(a, b); });
}

TransferFunction TransferFunction::mapped(double scale, double offset) const
{
    TransferFunction function(*this);
    for (Point& p : function._points)
        p.value = std::clamp(scale * p.value + offset, -FARTHEST, FARTHEST);
    return function;
}

std::vector<glm::vec4> TransferFunction::tabulateExtinction(int count, double low, double high,
                                                            bool texelCenters) const
{
    std::vector<glm::vec4> texels(static_cast<std::size_t>(std::max(count, 2)));
    const double n = static_cast<double>(texels.size());
    std::size_t after = 0; // first point beyond the value, while values ascend
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const double t =
            texelCenters ? (static_cast<double>(i) + 0.5) / n : static_cast<double>(i) / (n - 1.0);
        const double value = (1.0 - t) * low + t * high;
        while (after < _points.size() && _points[after].value <= value)
            ++after;
        glm::dvec4 color;
        if (low <= high && after > 0 && after < _points.size()) {
            const Point &a = _points[after - 1], &b = _points[after];
            const double f = (0.5 * value - 0.5 * a.value) / (0.5 * b.value - 0.5 * a.value);
            color = (1.0 - f) * a.color + f * b.color;
        } else {
            color = evaluate(value);
        }
        texels[i] =
            glm::vec4(glm::dvec4(color.r, color.g, color.b, extinctionFromOpacity(color.a)));
    }
    return texels;
}

double extinctionFromOpacity(double alpha)
{
    constexpr double opaque = 1.0 - 1.0 / 16777216.0;
    if (!(alpha > 0.0)) return 0.0;
    return -std::log1p(-std::min(alpha, opaque));
}

double opacityFromExtinction(double extinctionPerUnit, double lengthUnits)
{
    return -std::expm1(-extinctionPerUnit * lengthUnits);
}

} // namespace core
} // namespace osgVolumizer
