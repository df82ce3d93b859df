#include "Field.h"

#include <cmath>

namespace osgVolumizer {
namespace oracle {
namespace {

constexpr double pi = 3.14159265358979323846;

double dot(const glm::dvec3& a, const glm::dvec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

} // namespace

void Field::appendBreaks(const glm::dvec3&, const glm::dvec3&, double t0, double t1,
                         const std::vector<double>&, std::vector<double>& breaks) const
{
    for (int i = 1; i < 64; ++i)
        breaks.push_back(t0 + (t1 - t0) * i / 64.0);
}

double RampField::value(const glm::dvec3& p) const
{
    return _offset + dot(_slope, p);
}

void RampField::appendBreaks(const glm::dvec3& origin, const glm::dvec3& direction, double t0,
                             double t1, const std::vector<double>& values,
                             std::vector<double>& breaks) const
{
    const double slope = dot(_slope, direction);
    for (double v : values) {
        const double t = (v - value(origin)) / slope;
        if (t > t0 && t < t1) breaks.push_back(t);
    }
}

glm::dvec3 ProductField::gradient(const glm::dvec3& p) const
{
    return _scale * glm::dvec3(p.y * p.z, p.x * p.z, p.x * p.y);
}

double GaussianField::value(const glm::dvec3& p) const
{
    const glm::dvec3 d = p - _center;
    return _amplitude * std::exp(-0.5 * dot(d, d) / (_sigma * _sigma));
}

glm::dvec3 GaussianField::gradient(const glm::dvec3& p) const
{
    return (_center - p) * (value(p) / (_sigma * _sigma));
}

double MarschnerLobbField::value(const glm::dvec3& p) const
{
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    const double wave = std::cos(2.0 * pi * _frequency * std::cos(0.5 * pi * r));
    return (1.0 - std::sin(0.5 * pi * p.z) + _alpha * (1.0 + wave)) / (2.0 * (1.0 + _alpha));
}

glm::dvec3 MarschnerLobbField::gradient(const glm::dvec3& p) const
{
    const double scale = 1.0 / (2.0 * (1.0 + _alpha));
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    const double z = -0.5 * pi * std::cos(0.5 * pi * p.z) * scale;
    if (r == 0.0) return {0.0, 0.0, z}; // the wave is even in r
    const double phase = 2.0 * pi * _frequency * std::cos(0.5 * pi * r);
    const double radial =
        _alpha * std::sin(phase) * pi * pi * _frequency * std::sin(0.5 * pi * r) * scale;
    return {radial * p.x / r, radial * p.y / r, z};
}

} // namespace oracle
} // namespace osgVolumizer
