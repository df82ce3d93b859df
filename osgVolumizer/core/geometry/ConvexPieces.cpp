#include "ConvexPieces.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::size_t MAX_CORNERS = 1024;

Status invalid(const std::string& what, std::int64_t index = -1)
{
    return {ErrorCode::VALUE_INVALID, "Polygon: " + what, index};
}

/// The half-space on the left of the edge from a to b, upright on the plane.
Plane leftOf(const std::vector<glm::dvec3>& p, std::size_t a, std::size_t b,
             const glm::dvec3& normal)
{
    // Made in one order of the corners for both sides, then turned round by changing signs only.
    const std::size_t low = std::min(a, b), high = std::max(a, b);
    Plane plane;
    plane.normal = glm::cross(normal, p[high] - p[low]);
    plane.offset = -glm::dot(plane.normal, p[low]);
    if (a > b) plane = {-plane.normal, -plane.offset};
    return plane;
}

double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& normal)
{
    return glm::dot(glm::cross(b - a, c - a), normal);
}

/// Index in `rest` of a corner whose triangle holds no other, or the flattest one if rounding
/// leaves none.
std::size_t findEar(const std::vector<glm::dvec3>& p, const std::vector<std::size_t>& rest,
                    const glm::dvec3& normal)
{
    const std::size_t n = rest.size();
    std::size_t best = 0;
    double bestTurn = -1.0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t a = rest[(i + n - 1) % n], b = rest[i], c = rest[(i + 1) % n];
        const double t = turn(p[a], p[b], p[c], normal);
        if (t > bestTurn) best = i, bestTurn = t;
        if (!(t > 0.0)) continue;
        bool ear = true;
        for (const std::size_t k : rest)
            ear = ear && (k == a || k == b || k == c ||
                          !(turn(p[a], p[b], p[k], normal) >= 0.0 &&
                            turn(p[b], p[c], p[k], normal) >= 0.0 &&
                            turn(p[c], p[a], p[k], normal) >= 0.0));
        if (ear) return i;
    }
    return best;
}

} // namespace

Status convexPieces(const std::vector<glm::dvec3>& polygon, Plane& plane,
                    std::vector<std::vector<Plane>>& pieces)
{
    pieces.clear();
    const std::size_t n = polygon.size();
    if (n < 3) return invalid("it has " + std::to_string(n) + " corners.");
    if (n > MAX_CORNERS)
        return {ErrorCode::TOO_LARGE,
                "Polygon: it has " + std::to_string(n) + " corners; 1024 are possible."};
    double size = 0.0;
    glm::dvec3 normal(0.0); // Newell's
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 a = polygon[i] - polygon[0], b = polygon[(i + 1) % n] - polygon[0];
        normal += glm::cross(a, b);
        size = std::max(size, glm::length(a));
        if (!std::isfinite(glm::length(a)))
            return invalid("corner " + std::to_string(i) + " is not finite.",
                           static_cast<std::int64_t>(i));
    }
    const double length = glm::length(normal);
    if (!(length > 1e-12 * size * size)) return invalid("it has no area.");
    plane.normal = normal / length;
    plane.offset = -glm::dot(plane.normal, polygon[0]);
    bool convex = true;
    for (std::size_t i = 0; i < n; ++i) {
        if (std::abs(glm::dot(plane.normal, polygon[i] - polygon[0])) > 1e-6 * size)
            return invalid("corner " + std::to_string(i) + " lies off the plane of the others.",
                           static_cast<std::int64_t>(i));
        for (std::size_t k = 0; k < n; ++k)
            convex = convex && turn(polygon[i], polygon[(i + 1) % n], polygon[k], plane.normal) >=
                                   -1e-12 * size * size;
    }
    std::vector<std::size_t> rest(n);
    std::iota(rest.begin(), rest.end(), std::size_t(0));
    while (!convex && rest.size() > 3) {
        const std::size_t ear = findEar(polygon, rest, plane.normal);
        const std::size_t a = rest[(ear + rest.size() - 1) % rest.size()], b = rest[ear],
                          c = rest[(ear + 1) % rest.size()];
        pieces.push_back({leftOf(polygon, a, b, plane.normal), leftOf(polygon, b, c, plane.normal),
                          leftOf(polygon, c, a, plane.normal)});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    pieces.emplace_back();
    for (std::size_t i = 0; i < rest.size(); ++i)
        pieces.back().push_back(
            leftOf(polygon, rest[i], rest[(i + 1) % rest.size()], plane.normal));
    return {};
}

} // namespace core
} // namespace osgVolumizer
