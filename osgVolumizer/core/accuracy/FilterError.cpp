#include "FilterError.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace osgVolumizer {
namespace core {

namespace {

constexpr int PLACES = 4096;
constexpr double LN2 = 0.6931471805599453;

// Sum of the absolute differences per voxel along the axes about a place; those to where nothing
// shows do not count.
double steepness(const FractionField& field, const Box3d& box, const glm::dvec3& p)
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 low = p, high = p;
        low[axis] = std::max(p[axis] - 0.5, box.min[axis]);
        high[axis] = std::min(p[axis] + 0.5, box.max[axis]);
        const double width = high[axis] - low[axis];
        const double d = std::abs(field(high) - field(low));
        if (width > 0.0 && std::isfinite(d)) sum += d / width;
    }
    return sum;
}

// How far colour and extinction change about a value for a small change of it: over a distance at
// least, so that random places find jumps.
glm::dvec4 change(const IntervalTable& table, double value, double by)
{
    constexpr double LEAST = 1.0 / 16384.0;
    const auto at = [&](double v) { return table.at(table.find(v), v); };
    const double step = std::max(by, LEAST);
    const glm::dvec4 middle = at(value);
    const glm::dvec4 up = glm::abs(at(value + step) - middle);
    const glm::dvec4 down = glm::abs(at(value - step) - middle);
    return glm::max(up, down) * (by / step);
}

} // namespace

double filterError(const FractionField& field, const Box3d& box, const glm::dmat3& voxelToUnits,
                   const IntervalTable& table, double filterWeight)
{
    if (box.empty() || !(filterWeight > 0.0)) return 0.0;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    double colors = 0.0, extinctions = 0.0;
    for (int i = 0; i < PLACES; ++i) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        const glm::dvec3 p = box.min + (box.max - box.min) * glm::dvec3(x, y, z);
        const double value = field(p);
        if (!std::isfinite(value)) continue;
        const glm::dvec4 d = change(table, value, filterWeight * steepness(field, box, p));
        extinctions += d.a * d.a;
        const double color = std::max({d.r, d.g, d.b});
        if (table.at(table.find(value), value).a > 0.0) colors += color * color;
    }
    const double length = glm::length(voxelToUnits * (box.max - box.min));
    return std::sqrt(colors / PLACES) + LN2 * length * std::sqrt(extinctions / PLACES);
}

} // namespace core
} // namespace osgVolumizer
