#include "RaySamples.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

double RaySamples::at(double place) const
{
    const auto i = std::min(static_cast<std::size_t>(place), values.size() - 2);
    const double f = place - static_cast<double>(i), a = double(values[i]),
                 b = double(values[i + 1]);
    if (std::isnan(a) || std::isnan(b)) return f < 0.5 ? a : b;
    return a + f * (b - a);
}

glm::dvec4 RaySamples::integrate(const ExtinctionTable& table, double periodIntervals) const
{
    const int steps = std::max(1, static_cast<int>(length() / periodIntervals + 0.5));
    const double h = length() / steps;
    glm::dvec3 color(0.0);
    double through = 1.0, before = at(0.0);
    for (int i = 0; i < steps && through > 3e-5; ++i) {
        const double after = table.integrals ? at((i + 1) * h) : 0.0;
        const glm::dvec4 c =
            table.integrals ? table.mean(before, after) : table.at(at((i + 0.5) * h));
        const double next = through * std::exp2(-c.a * h * unitsPerInterval);
        color += (through - next) * glm::dvec3(c);
        through = next;
        before = after;
    }
    return glm::dvec4(color, 1.0 - through);
}

} // namespace core
} // namespace osgVolumizer
