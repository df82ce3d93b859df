#include "PreIntegration.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double LEAST_TRANSPARENCY = 1.0 / 16777216.0; // as in extinctionFromOpacity()

/// Moments of -ln(1 + r t) over t in [-1, 1]: its mean, and the mean of t times it.
struct LogMoments
{
    double zeroth, first;
};

LogMoments logMoments(double r)
{
    if (std::fabs(r) > 0.2) {
        const double a = 1.0 + r, b = 1.0 - r, la = std::log(a), lb = std::log(b);
        const auto part = [](double v, double l) {
            return v * v * (0.5 * l - 0.25) - v * (l - 1.0);
        };
        return {1.0 - (a * la - b * lb) / (2.0 * r), -(part(a, la) - part(b, lb)) / (2.0 * r * r)};
    }
    // The closed form cancels near zero; this series has 16 digits after 12 terms.
    LogMoments m{0.0, 0.0};
    double power = r;
    for (int k = 1; k < 24 && std::fabs(power) > 1e-17; k += 2, power *= r * r) {
        m.first -= power / (k * (k + 2.0));
        m.zeroth += power * r / ((k + 1.0) * (k + 2.0));
    }
    return m;
}

/// Mean of (extinction * rgb, extinction) over a piece on which colour and opacity are linear, and
/// transparency stays above the least on both ends.
glm::dvec4 meanOfSmoothPiece(const glm::dvec4& a, const glm::dvec4& b)
{
    const double ua = std::max(1.0 - a.a, LEAST_TRANSPARENCY);
    const double ub = std::max(1.0 - b.a, LEAST_TRANSPARENCY);
    const LogMoments m = logMoments((ub - ua) / (ub + ua));
    const double extinction = m.zeroth - std::log(0.5 * (ua + ub));
    const glm::dvec3 middle = 0.5 * (glm::dvec3(a) + glm::dvec3(b));
    const glm::dvec3 half = 0.5 * (glm::dvec3(b) - glm::dvec3(a));
    return glm::dvec4(middle * extinction + half * m.first, extinction);
}

/// The same for any piece: where opacity is held below 1 the extinction is constant.
glm::dvec4 meanOfPiece(const glm::dvec4& a, const glm::dvec4& b)
{
    const double ua = 1.0 - a.a, ub = 1.0 - b.a;
    if ((ua < LEAST_TRANSPARENCY) == (ub < LEAST_TRANSPARENCY)) return meanOfSmoothPiece(a, b);
    const double t = (LEAST_TRANSPARENCY - ua) / (ub - ua);
    const glm::dvec4 split((1.0 - t) * a + t * b);
    return t * meanOfSmoothPiece(a, split) + (1.0 - t) * meanOfSmoothPiece(split, b);
}

glm::dvec4 emission(const glm::dvec4& color)
{
    const double extinction = extinctionFromOpacity(color.a);
    return {color.r * extinction, color.g * extinction, color.b * extinction, extinction};
}

double valueOf(int i, int count, double low, double high)
{
    const double t = static_cast<double>(i) / (count - 1);
    return (1.0 - t) * low + t * high;
}

} // namespace

TransferIntegral::TransferIntegral(const TransferFunction& function) : _function(function)
{
    const auto& points = _function.points();
    _atPoint.resize(points.size(), glm::dvec4(0.0));
    for (std::size_t i = 1; i < points.size(); ++i)
        _atPoint[i] = _atPoint[i - 1] + (points[i].value - points[i - 1].value) *
                                            meanOfPiece(points[i - 1].color, points[i].color);
}

glm::dvec4 TransferIntegral::integral(double value) const
{
    const auto& points = _function.points();
    const auto after =
        std::upper_bound(points.begin(), points.end(), value,
                         [](double v, const TransferFunction::Point& p) { return v < p.value; });
    if (after == points.begin()) return (value - after->value) * emission(after->color);
    const auto& before = *(after - 1);
    const glm::dvec4 start = _atPoint[static_cast<std::size_t>(after - points.begin()) - 1];
    if (after == points.end()) return start + (value - before.value) * emission(before.color);
    return start + (value - before.value) * meanOfPiece(before.color, _function.evaluate(value));
}

glm::dvec4 TransferIntegral::mean(double front, double back) const
{
    const auto& points = _function.points();
    const double low = std::min(front, back), high = std::max(front, back);
    if (!(low < high)) return emission(_function.evaluate(front));
    const auto after =
        std::upper_bound(points.begin(), points.end(), low,
                         [](double v, const TransferFunction::Point& p) { return v < p.value; });
    // Within one piece no difference of integrals is needed, and so nothing cancels.
    if (after != points.end() && high <= after->value && after != points.begin())
        if (high < after->value)
            return meanOfPiece(_function.evaluate(low), _function.evaluate(high));
    return (integral(high) - integral(low)) / (high - low);
}

std::vector<glm::dvec4> TransferIntegral::tabulate(int count, double low, double high) const
{
    const auto& points = _function.points();
    std::vector<glm::dvec4> result(static_cast<std::size_t>(std::max(count, 2)));
    const int n = static_cast<int>(result.size());
    std::size_t after = 0; // first point beyond a
    double a = low;
    glm::dvec4 colorA = _function.evaluate(a);
    for (int i = 1; i < n; ++i) {
        const double b = valueOf(i, n, low, high);
        while (after < points.size() && points[after].value <= a)
            ++after;
        glm::dvec4 colorB, step;
        if (after == points.size() || (after == 0 && b < points[0].value)) {
            colorB = colorA;
            step = emission(colorA);
        } else if (after > 0 && b < points[after].value) {
            const auto &p = points[after - 1], &q = points[after];
            const double t = (b - p.value) / (q.value - p.value);
            colorB = (1.0 - t) * p.color + t * q.color;
            step = meanOfPiece(colorA, colorB);
        } else {
            colorB = _function.evaluate(b);
            step = mean(a, b);
        }
        result[static_cast<std::size_t>(i)] = result[static_cast<std::size_t>(i) - 1] + step;
        a = b;
        colorA = colorB;
    }
    return result;
}

WindowError windowError(const TransferFunction& function, double low, double high, double width)
{
    WindowError worst;
    if (!(low < high) || !(width > 0.0)) return worst;
    const TransferIntegral integral(function);
    const auto shown = [](const glm::dvec4& emitted) {
        const double opacity = opacityFromExtinction(emitted.a, 1.0);
        const double scale = emitted.a > 0.0 ? opacity / emitted.a : 0.0;
        return glm::dvec4(scale * glm::dvec3(emitted), opacity);
    };
    const auto compare = [&](double value) {
        const double a = std::max(value - 0.5 * width, low),
                     b = std::min(value + 0.5 * width, high);
        if (!(a < b)) return;
        const glm::dvec4 d =
            shown(integral.mean(a, b)) - shown(emission(function.evaluate(0.5 * (a + b))));
        for (int c = 0; c < 4; ++c)
            if (std::fabs(d[c]) > worst.error) worst = {std::fabs(d[c]), value};
    };
    const int count = static_cast<int>(std::min(std::ceil(8.0 * (high - low) / width), 65536.0));
    for (int i = 0; i <= count; ++i)
        compare(valueOf(i, count + 1, low, high));
    // Points may lie much closer than a width; one for every eighth of it is enough.
    double last = low - width;
    for (const auto& p : function.points())
        if (p.value >= low && p.value <= high && p.value - last > width / 8.0) {
            compare(p.value);
            last = p.value;
        }
    return worst;
}

} // namespace core
} // namespace osgVolumizer
