#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>

namespace osgVolumizer {
namespace oracle {

/// Premultiplied RGBA of a segment of one colour (straight RGBA), `lengthUnits` opacity units long.
inline glm::dvec4 constantSegment(const glm::dvec4& color, double lengthUnits)
{
    const double alpha = -std::expm1(std::log1p(-color.a) * lengthUnits);
    return glm::dvec4(alpha * glm::dvec3(color), alpha);
}

/// Premultiplied RGBA of a segment whose opacity goes linearly from a0 to a1, both below 1, while
/// its colour is constant: the integral of -ln(1-a) da is (1-a) ln(1-a) + a.
inline glm::dvec4 rampSegment(const glm::dvec3& color, double a0, double a1, double lengthUnits)
{
    const auto primitive = [](double a) { return (1.0 - a) * std::log1p(-a) + a; };
    const double depth = a0 == a1 ? -std::log1p(-a0) * lengthUnits
                                  : lengthUnits * (primitive(a1) - primitive(a0)) / (a1 - a0);
    const double alpha = -std::expm1(-depth);
    return glm::dvec4(alpha * color, alpha);
}

/// Premultiplied 'over': a in front of b.
inline glm::dvec4 over(const glm::dvec4& a, const glm::dvec4& b)
{
    return a + (1.0 - a.a) * b;
}

} // namespace oracle
} // namespace osgVolumizer
