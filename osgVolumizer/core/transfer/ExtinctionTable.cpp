#include "ExtinctionTable.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace osgVolumizer {
namespace core {

int ExtinctionTable::nearest(double fraction) const
{
    const double last = count - 1.0;
    return static_cast<int>(std::clamp(fraction, 0.0, 1.0) * last + 0.5);
}

glm::dvec4 ExtinctionTable::at(double fraction) const
{
    if (std::isnan(fraction)) return glm::dvec4(0.0);
    return glm::dvec4(texels[nearest(fraction)]);
}

glm::dvec4 ExtinctionTable::mean(double from, double to) const
{
    if (std::isnan(from) || std::isnan(to)) return at(std::isnan(from) ? to : from);
    const int a = nearest(from), b = nearest(to);
    // Differences of floats over few entries are off by more than the entry in the middle.
    if (std::abs(a - b) < 4) return at(0.5 * (from + to));
    const glm::vec4* integral = texels + count;
    const glm::dvec4 mean = (glm::dvec4(integral[b]) - glm::dvec4(integral[a])) / double(b - a);
    return glm::dvec4(glm::dvec3(mean) / std::max(mean.a, 1e-12), mean.a);
}

} // namespace core
} // namespace osgVolumizer
