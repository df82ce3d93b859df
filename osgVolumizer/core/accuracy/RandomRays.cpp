#include "RandomRays.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

// What directions are about, and the opposite ones. Errors are largest along axes, where
// all rays of a view meet samples in step, and along diagonals, where cells are longest.
const glm::ivec3 MIDDLES[RandomRays::DIRECTIONS / 2] = {
    {1, 0, 0},  {0, 1, 0}, {0, 0, 1},  {1, 1, 0},  {1, -1, 0},  {1, 0, 1}, {-1, 0, 1}, {0, 1, 1},
    {0, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}, {1, 2, 4}, {-2, 4, 1}, {4, -1, 2}};
constexpr double SPREAD = 0.08;

// Central differences over one sample to each side, less at the ends of a box.
glm::dvec3 centralDifferences(const FractionField& field, const Box3d& box, const glm::dvec3& p)
{
    glm::dvec3 result(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 low = p, high = p;
        low[axis] = std::max(p[axis] - 1.0, box.min[axis]);
        high[axis] = std::min(p[axis] + 1.0, box.max[axis]);
        const double length = high[axis] - low[axis];
        if (length > 0.0) result[axis] = (field(high) - field(low)) / length;
    }
    return result;
}

} // namespace

RandomRays::RandomRays(const Box3d& box, const glm::dmat3& voxelToUnits, bool nearest, bool lit)
    : _box(box), _samples(box), _voxelToUnits(voxelToUnits), _nearest(nearest), _lit(lit)
{
    // A plane of samples has rays, too.
    constexpr double LEAST = 1e-3;
    _box.min -= LEAST;
    _box.max += LEAST;
}

glm::dvec3 RandomRays::randomDirection()
{
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double z = 2.0 * unit(_random) - 1.0, angle = glm::two_pi<double>() * unit(_random);
    const double s = std::sqrt(1.0 - z * z);
    return {s * std::cos(angle), s * std::sin(angle), z};
}

CellRay RandomRays::next(const FractionField& field)
{
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto random = [&]() { return unit(_random); };
    const double radius = 0.5 * glm::length(_box.size());
    const std::size_t i = _count++ % DIRECTIONS;
    const glm::dvec3 about = (i % 2 == 0 ? 1.0 : -1.0) * glm::normalize(glm::dvec3(MIDDLES[i / 2]));
    for (;;) {
        const glm::dvec3 direction =
            glm::normalize(about + SPREAD * std::sqrt(random()) * randomDirection());
        const glm::dvec3 side = glm::normalize(glm::cross(
            direction, std::abs(direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
        const double r = radius * std::sqrt(random()), angle = glm::two_pi<double>() * random();
        const glm::dvec3 point =
            _box.center() +
            r * (std::cos(angle) * side + std::sin(angle) * glm::cross(direction, side));
        double enter = -2.0 * radius, leave = 2.0 * radius;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (_box.min[axis] - point[axis]) / direction[axis];
            const double b = (_box.max[axis] - point[axis]) / direction[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (!(leave - enter > 1e-6 * radius)) continue;
        RayPath path{point + enter * direction, point + leave * direction, _voxelToUnits};
        const FractionField held = [this, &field](const glm::dvec3& p) {
            return field(glm::clamp(p, _samples.min, _samples.max));
        };
        if (!_lit) return CellRay(path, held, nullptr, _nearest);
        const bool fromEye = _count / DIRECTIONS % 2 == 0;
        path.toLight = fromEye ? -glm::normalize(_voxelToUnits * direction) : randomDirection();
        const GradientField gradient = [this, &held](const glm::dvec3& p) {
            return centralDifferences(held, _samples, glm::clamp(p, _samples.min, _samples.max));
        };
        return CellRay(path, held, gradient, _nearest);
    }
}

} // namespace core
} // namespace osgVolumizer
