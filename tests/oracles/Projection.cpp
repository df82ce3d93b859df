#include "Projection.h"

#include "Ray.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace oracle {

namespace {

// Ends and breaks of the field on the ray, ascending.
std::vector<double> breaksOf(const Crossing& c, const std::vector<double>& values)
{
    std::vector<double> breaks{c.enter, c.leave};
    c.volume->field->appendBreaks(c.fieldOrigin, c.fieldDirection, c.enter, c.leave, values,
                                  breaks);
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

double valueAt(const Crossing& c, double depth)
{
    return c.volume->field->value(c.fieldOrigin + depth * c.fieldDirection);
}

// Where the derivative of the cubic through f[n] at n/3 of [0, 1] vanishes.
std::vector<double> extremaOfCubic(const double f[4])
{
    const double c1 = 0.5 * (-11.0 * f[0] + 18.0 * f[1] - 9.0 * f[2] + 2.0 * f[3]);
    const double c2 = 4.5 * (2.0 * f[0] - 5.0 * f[1] + 4.0 * f[2] - f[3]);
    const double c3 = 4.5 * (-f[0] + 3.0 * f[1] - 3.0 * f[2] + f[3]);
    const double a = 3.0 * c3, b = 2.0 * c2, discriminant = b * b - 4.0 * a * c1;
    if (discriminant < 0.0) return {};
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    return {q / a, c1 / q};
}

} // namespace

bool project(const Volume& volume, const Camera& camera, double x, double y, Projection& result)
{
    Crossing c;
    if (!cross(rayThrough(camera, x, y), camera, volume, c)) return false;
    const std::vector<double> breaks = breaksOf(c, {});
    result = Projection();
    result.maximum = -INFINITY;
    result.minimum = INFINITY;
    const double unitsPerDepth = c.objectLength / volume.unit;
    result.length = (c.leave - c.enter) * unitsPerDepth;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const double t = breaks[i], h = breaks[i + 1] - t;
        double f[4];
        for (int n = 0; n < 4; ++n)
            f[n] = valueAt(c, t + h * n / 3.0);
        // Exact for cubics.
        result.integral += h * unitsPerDepth * 0.125 * (f[0] + 3.0 * f[1] + 3.0 * f[2] + f[3]);
        std::vector<double> places = extremaOfCubic(f);
        places.push_back(0.0);
        places.push_back(1.0);
        for (double place : places) {
            if (!(place >= 0.0 && place <= 1.0)) continue;
            const double value = valueAt(c, t + h * place);
            result.maximum = std::max(result.maximum, value);
            result.minimum = std::min(result.minimum, value);
        }
    }
    return true;
}

bool firstCrossing(const Volume& volume, const Camera& camera, double x, double y, double value,
                   double& depth)
{
    Crossing c;
    if (!cross(rayThrough(camera, x, y), camera, volume, c)) return false;
    const std::vector<double> breaks = breaksOf(c, {value});
    for (double t : breaks) {
        if (t <= c.enter || t >= c.leave || std::abs(valueAt(c, t) - value) > 1e-9) continue;
        depth = t;
        return true;
    }
    return false;
}

} // namespace oracle
} // namespace osgVolumizer
