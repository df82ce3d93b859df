#include "Resampling.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

/// Premultiplied colour and opacity of one unit.
glm::dvec4 premultiplied(const glm::dvec4& c)
{
    return {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
}

/// What a linear texture fetch of the table gives. Texels are made when first asked for, so that a
/// comparison that ends early costs no whole table.
class Fetch
{
public:
    Fetch(const TransferFunction& function, int count, double low, double high, TexelPlaces places)
        : _function(function), _count(std::max(count, 2)), _low(low), _high(high), _places(places)
    {
    }
    /// Makes all texels.
    void tabulate()
    {
        _texels =
            _function.tabulateExtinction(_count, _low, _high, _places == TexelPlaces::CENTERS);
    }
    /// `t`: fraction of [low, high].
    glm::dvec4 operator()(double t) const
    {
        const double n = _count;
        const double x = _places == TexelPlaces::CENTERS ? t * n - 0.5 : t * (n - 1.0);
        const double held = std::min(std::max(x, 0.0), n - 1.0);
        const int i = static_cast<int>(std::min(std::floor(held), n - 2.0));
        const double f = held - i;
        const glm::dvec4 v = (1.0 - f) * texel(i) + f * texel(i + 1);
        return premultiplied({v.r, v.g, v.b, opacityFromExtinction(v.a, 1.0)});
    }

private:
    glm::dvec4 texel(int i) const
    {
        if (!_texels.empty()) return glm::dvec4(_texels[static_cast<std::size_t>(i)]);
        const double t = _places == TexelPlaces::CENTERS ? (i + 0.5) / _count : i / (_count - 1.0);
        glm::dvec4 color = _function.evaluate((1.0 - t) * _low + t * _high);
        color.a = extinctionFromOpacity(color.a);
        return glm::dvec4(glm::vec4(color));
    }

    const TransferFunction& _function;
    int _count;
    double _low, _high;
    TexelPlaces _places;
    std::vector<glm::vec4> _texels;
};

double largestChannel(const glm::dvec4& d)
{
    return std::max(std::max(std::fabs(d.r), std::fabs(d.g)),
                    std::max(std::fabs(d.b), std::fabs(d.a)));
}

/// The middle of the steepest step between two points, where coarse texels go wrong first.
double steepestPlace(const std::vector<TransferFunction::Point>& points)
{
    double steepest = -1.0, place = points[0].value;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double change = largestChannel(points[i].color - points[i - 1].color);
        if (change <= steepest) continue;
        steepest = change;
        place = 0.5 * points[i - 1].value + 0.5 * points[i].value;
    }
    return place;
}

/// Number of equal steps of the points over [low, high]; 0 where they are uneven.
int evenSteps(const TransferFunction& function, double low, double high)
{
    const auto& points = function.points();
    if (points.size() < 2) return 0;
    const int steps = static_cast<int>(points.size()) - 1;
    for (int i = 0; i <= steps; ++i) {
        const double even = low + (high - low) * i / steps;
        if (std::fabs(points[static_cast<std::size_t>(i)].value - even) > 1e-9 * (high - low))
            return 0;
    }
    return steps;
}

} // namespace

double resamplingError(const TransferFunction& function, int count, double low, double high,
                       TexelPlaces places, double stopAbove)
{
    if (!(low < high)) return 0.0;
    Fetch fetch(function, count, low, high, places);
    double error = 0.0;
    const auto compare = [&](double value, const glm::dvec4& color) {
        const double t = (value - low) / (high - low);
        error = std::max(error, largestChannel(fetch(t) - premultiplied(color)));
    };
    const auto& points = function.points();
    const double place = std::min(std::max(steepestPlace(points), low), high);
    compare(place, function.evaluate(place));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& p = points[i];
        if (i == 64) fetch.tabulate();
        if (p.value >= low && p.value <= high) compare(p.value, p.color);
        if (error > stopAbove) return error;
    }
    fetch.tabulate();
    // Between texels: the largest deviation of a steep exponential lies near an end, hence uneven
    // steps.
    static const double steps[] = {0.02, 0.06, 0.12, 0.25, 0.5, 0.75, 0.88, 0.94, 0.98};
    const double texels = std::max(count, 2) - (places == TexelPlaces::ENDS ? 1.0 : 0.0);
    const double shift = places == TexelPlaces::ENDS ? 0.0 : 0.5;
    // From the high end, where opacity usually is highest and the error largest.
    for (double i = texels - 1.0 + shift; i >= -shift; i -= 1.0) {
        for (const double f : steps) {
            const double t = (i + f) / texels;
            if (t < 0.0 || t > 1.0) continue;
            const double value = (1.0 - t) * low + t * high;
            compare(value, function.evaluate(value));
        }
        if (error > stopAbove) return error;
    }
    return error;
}

TexelChoice chooseTexelCount(const TransferFunction& function, double low, double high,
                             TexelPlaces places, double tolerance, int maximum)
{
    std::vector<int> counts;
    for (int n = 2; n <= maximum; n *= 2) {
        counts.push_back(n);
        if (n + 1 <= maximum) counts.push_back(n + 1);
    }
    if (const int steps = evenSteps(function, low, high))
        for (std::int64_t n = steps; n < maximum; n *= 2)
            counts.push_back(static_cast<int>(n) + 1);
    counts.push_back(std::max(maximum, 2));
    std::sort(counts.begin(), counts.end());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    TexelChoice choice;
    for (const int n : counts) {
        choice = {n, resamplingError(function, n, low, high, places, tolerance)};
        if (choice.error <= tolerance) break;
    }
    return choice;
}

} // namespace core
} // namespace osgVolumizer
