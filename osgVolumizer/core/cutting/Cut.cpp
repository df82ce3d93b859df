#include "Cut.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

// By how far a place is from the middle along each axis, with which it grows.
double outsideBy(const CutShape& shape, const glm::dvec3& fromCenter)
{
    const glm::dvec3 q = fromCenter - shape.halfSize;
    return glm::length(glm::max(q, glm::dvec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0) -
           shape.radius;
}

} // namespace

double CutShape::distance(const glm::dvec3& p) const
{
    const double outside = outsideBy(*this, glm::abs(p - center));
    return keepInside ? -outside : outside;
}

ValueRange CutShape::rangeIn(const Box3d& box) const
{
    const glm::dvec3 low = box.min - center, high = box.max - center;
    const double nearest = outsideBy(*this, glm::max(glm::max(low, -high), glm::dvec3(0.0)));
    const double farthest = outsideBy(*this, glm::max(glm::abs(low), glm::abs(high)));
    if (keepInside) return {-farthest, -nearest};
    return {nearest, farthest};
}

double Cut::distance(const glm::dvec3& place) const
{
    double d = field ? field->at(place) : std::numeric_limits<double>::infinity();
    for (const Plane& plane : planes)
        d = std::min(d, plane.distance(place));
    for (const CutShape& shape : shapes)
        d = std::min(d, shape.distance(place));
    return d;
}

double Cut::share(const glm::dvec3& place) const
{
    const double d = distance(place);
    if (softness > 0.0) return std::clamp(d / softness + 0.5, 0.0, 1.0);
    return d >= 0.0 ? 1.0 : 0.0;
}

ValueRange Cut::rangeIn(const Box3d& box) const
{
    const double infinite = std::numeric_limits<double>::infinity();
    ValueRange range = field ? field->rangeIn(box) : ValueRange{infinite, infinite};
    const glm::dvec3 center = box.center();
    const auto narrow = [&](double low, double high) {
        range = {std::min(range.low, low), std::min(range.high, high)};
    };
    for (const CutShape& shape : shapes) {
        const ValueRange r = shape.rangeIn(box);
        narrow(r.low, r.high);
    }
    for (const Plane& plane : planes) {
        const double d = plane.distance(center);
        const double half = glm::dot(glm::abs(plane.normal), 0.5 * box.size());
        narrow(d - half, d + half);
    }
    return range;
}

bool Cut::keepsNothingOf(const Box3d& box) const
{
    return rangeIn(box).high < -0.5 * softness;
}

bool Cut::keepsAllOf(const Box3d& box) const
{
    return rangeIn(box).low >= 0.5 * softness;
}

std::vector<std::pair<double, double>>
Cut::keptParts(const glm::dvec3& start, const glm::dvec3& end, double resolution) const
{
    std::vector<std::pair<double, double>> parts;
    const glm::dvec3 direction = end - start;
    const double length = glm::length(direction);
    if (!(length > 0.0)) return parts;
    const auto distanceAt = [&](double t) { return distance(start + t * direction); };
    const double least = resolution / length;
    double t = 0.0, d = distanceAt(0.0), begin = 0.0;
    while (t < 1.0) {
        const double next = std::min(1.0, t + std::max(least, std::abs(d) / length));
        const double after = distanceAt(next);
        if ((d >= 0.0) != (after >= 0.0)) {
            double low = t, high = next;
            for (int i = 0; i < 50; ++i) {
                const double middle = 0.5 * (low + high);
                ((distanceAt(middle) >= 0.0) == (d >= 0.0) ? low : high) = middle;
            }
            if (d >= 0.0)
                parts.emplace_back(begin, low);
            else
                begin = high;
        }
        t = next;
        d = after;
    }
    if (d >= 0.0) parts.emplace_back(begin, 1.0);
    return parts;
}

unsigned nextCutId()
{
    static std::atomic<unsigned> last{0};
    return ++last;
}

} // namespace core
} // namespace osgVolumizer
