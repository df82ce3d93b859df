#include "RandomRays.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgVolumizer {
namespace core {

namespace {

// Rays that show something, at first and at most, in so much memory.
constexpr std::size_t RAYS = 1500, MOST_RAYS = 12000, MOST_SAMPLES = 8000000;
// So many are tried for each that shows something.
constexpr std::size_t TRIALS = 6;
// Opacity of a ray that shows something.
constexpr double VISIBLE = 1e-3;

} // namespace

RandomRays::RandomRays(const FractionField& field, const PeriodQuestion& question,
                       double samplesPerVoxel)
    : _field(field), _question(question), _samplesPerVoxel(samplesPerVoxel)
{
    grow(RAYS);
}

bool RandomRays::doubleRays()
{
    const std::size_t count = 2 * _rays.size();
    if (_rays.empty() || count > MOST_RAYS || 2 * _sampleCount > MOST_SAMPLES) return false;
    grow(count);
    return _rays.size() == count;
}

void RandomRays::grow(std::size_t count)
{
    const std::size_t trials = TRIALS * (count - _rays.size());
    for (std::size_t i = 0; i < trials && _rays.size() < count; ++i)
        tryRay();
}

void RandomRays::tryRay()
{
    const Box3d& box = _question.box;
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto next = [&]() { return unit(_random); };
    const double radius = 0.5 * glm::length(box.size());
    const double z = 2.0 * next() - 1.0, phi = glm::two_pi<double>() * next();
    const double s = std::sqrt(1.0 - z * z);
    const glm::dvec3 direction(s * std::cos(phi), s * std::sin(phi), z);
    const glm::dvec3 side = glm::normalize(
        glm::cross(direction, std::abs(z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
    const double r = radius * std::sqrt(next()), angle = glm::two_pi<double>() * next();
    const glm::dvec3 point =
        box.center() + r * (std::cos(angle) * side + std::sin(angle) * glm::cross(direction, side));
    double enter = -2.0 * radius, leave = 2.0 * radius;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - point[axis]) / direction[axis];
        const double b = (box.max[axis] - point[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    if (leave > enter) sample(point, direction, {enter, leave});
}

void RandomRays::sample(const glm::dvec3& point, const glm::dvec3& direction,
                        const glm::dvec2& ends)
{
    const double length = ends.y - ends.x;
    const int intervals = std::max(2, static_cast<int>(length * _samplesPerVoxel));
    const double interval = length / intervals;
    Ray ray;
    ray.samples.unitsPerInterval = interval * glm::length(_question.voxelToUnits * direction);
    ray.samples.values.reserve(std::size_t(intervals) + 1);
    for (int i = 0; i <= intervals; ++i)
        ray.samples.values.push_back(
            static_cast<float>(_field(point + (ends.x + i * interval) * direction)));
    const bool hasIntegrals = !_question.integrals.empty();
    ray.light =
        ray.samples.integrate(hasIntegrals ? _question.integrals : _question.midpoints, 1.0);
    if (!(ray.light.a > VISIBLE)) return;
    _sampleCount += ray.samples.values.size();
    _rays.push_back(std::move(ray));
}

} // namespace core
} // namespace osgVolumizer
