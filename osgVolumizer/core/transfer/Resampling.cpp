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

/// What a linear texture fetch of the table gives.
class Fetch
{
public:
    Fetch(const TransferFunction& function, int count, double low, double high, TexelPlaces places)
        : _texels(function.tabulateExtinction(count, low, high, places == TexelPlaces::CENTERS)),
          _places(places)
    {
    }
    /// `t`: fraction of [low, high].
    glm::dvec4 operator()(double t) const
    {
        const double n = static_cast<double>(_texels.size());
        const double x = _places == TexelPlaces::CENTERS ? t * n - 0.5 : t * (n - 1.0);
        const double held = std::min(std::max(x, 0.0), n - 1.0);
        const std::size_t i = static_cast<std::size_t>(std::min(std::floor(held), n - 2.0));
        const double f = held - static_cast<double>(i);
        const glm::dvec4 v = (1.0 - f) * glm::dvec4(_texels[i]) + f * glm::dvec4(_texels[i + 1]);
        return premultiplied({v.r, v.g, v.b, opacityFromExtinction(v.a, 1.0)});
    }

private:
    std::vector<glm::vec4> _texels;
    TexelPlaces _places;
};

double largest(const glm::dvec4& d)
{
    return std::max(std::max(std::fabs(d.r), std::fabs(d.g)),
                    std::max(std::fabs(d.b), std::fabs(d.a)));
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
                       TexelPlaces places)
{
    if (!(low < high)) return 0.0;
    const Fetch fetch(function, count, low, high, places);
    double error = 0.0;
    const auto compare = [&](double value, const glm::dvec4& color) {
        const double t = (value - low) / (high - low);
        error = std::max(error, largest(fetch(t) - premultiplied(color)));
    };
    const auto& points = function.points();
    for (const auto& p : points)
        if (p.value >= low && p.value <= high) compare(p.value, p.color);
    // Between texels: the largest deviation of a steep exponential lies near an end, hence uneven
    // steps.
    static const double steps[] = {0.02, 0.06, 0.12, 0.25, 0.5, 0.75, 0.88, 0.94, 0.98};
    const double texels = std::max(count, 2) - (places == TexelPlaces::ENDS ? 1.0 : 0.0);
    const double shift = places == TexelPlaces::ENDS ? 0.0 : 0.5;
    for (double i = -shift; i < texels; i += 1.0)
        for (const double f : steps) {
            const double t = (i + f) / texels;
            if (t < 0.0 || t > 1.0) continue;
            const double value = (1.0 - t) * low + t * high;
            compare(value, function.evaluate(value));
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
    TexelChoice best;
    best.error = INFINITY;
    for (const int n : counts) {
        const double error = resamplingError(function, n, low, high, places);
        if (error < best.error) best = {n, error};
        if (error <= tolerance) break;
    }
    return best;
}

} // namespace core
} // namespace osgVolumizer
