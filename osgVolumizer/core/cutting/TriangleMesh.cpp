#include "TriangleMesh.h"

#include "../Text.h"
#include "../geometry/EdgeMap.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace osgVolumizer {
namespace core {

Box3d TriangleMesh::bounds() const
{
    Box3d box;
    for (const std::uint32_t i : indices)
        box.expand(vertices[i]);
    return box;
}

Status TriangleMesh::validate() const
{
    if (indices.size() < 3) return {ErrorCode::VALUE_INVALID, "a surface has no triangles"};
    for (const std::uint32_t i : indices) {
        if (i >= vertices.size())
            return {ErrorCode::VALUE_INVALID, "a triangle of a surface has vertex " +
                                                  std::to_string(i) + " of " +
                                                  std::to_string(vertices.size())};
        const glm::dvec3& p = vertices[i];
        if (!std::isfinite(p.x + p.y + p.z))
            return {ErrorCode::VALUE_INVALID,
                    "vertex " + std::to_string(i) + " of a surface is not finite"};
    }
    return {};
}

TriangleMesh welded(const TriangleMesh& mesh, double tolerance)
{
    using Cell = std::array<double, 3>;
    constexpr std::uint32_t NONE = EdgeMap::NONE;
    const double edge = tolerance > 0.0 ? 2.0 * tolerance : 0.0;
    const glm::dvec3 origin = mesh.bounds().min;
    // Of exact places, adding 0 makes one zero of the two that there are.
    const auto cellOf = [&](const glm::dvec3& p) -> glm::dvec3 {
        return edge > 0.0 ? glm::floor((p - origin) / edge) : p + 0.0;
    };
    TriangleMesh result;
    std::map<Cell, std::vector<std::uint32_t>> cells;
    const auto numberOf = [&](const glm::dvec3& p) {
        std::uint32_t number = NONE;
        double nearest = tolerance;
        const glm::dvec3 low = cellOf(p - tolerance), high = cellOf(p + tolerance);
        for (int k = 0; k < (edge > 0.0 ? 8 : 1); ++k) {
            const auto found = cells.find(
                {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
            if (found == cells.end()) continue;
            for (const std::uint32_t i : found->second) {
                const double distance = glm::length(result.vertices[i] - p);
                if (distance > nearest) continue;
                nearest = distance;
                number = i;
            }
        }
        if (number != NONE) return number;
        const glm::dvec3 own = cellOf(p);
        number = static_cast<std::uint32_t>(result.vertices.size());
        cells[{own.x, own.y, own.z}].push_back(number);
        result.vertices.push_back(p);
        return number;
    };
    // In their order, so that a mesh that needs no welding stays as it is.
    std::vector<std::uint32_t> numbers(mesh.vertices.size(), NONE);
    for (const std::uint32_t i : mesh.indices)
        numbers[i] = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] != NONE) numbers[i] = numberOf(mesh.vertices[i]);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const std::uint32_t* corners = &mesh.indices[3 * t];
        const std::uint32_t i[3] = {numbers[corners[0]], numbers[corners[1]], numbers[corners[2]]};
        if (i[0] == i[1] || i[1] == i[2] || i[2] == i[0]) continue;
        result.indices.insert(result.indices.end(), i, i + 3);
    }
    return result;
}

Status checkClosed(const TriangleMesh& mesh)
{
    if (Status status = mesh.validate(); !status.ok()) return status;
    EdgeMap counts;
    const auto forEdges = [&mesh](auto&& f) {
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                if (!f(mesh.indices[3 * t + k], mesh.indices[3 * t + (k + 1) % 3])) return;
    };
    forEdges([&counts](std::uint32_t a, std::uint32_t b) {
        std::uint32_t& count = counts(a, b);
        count = count == EdgeMap::NONE ? 1 : count + 1;
        return true;
    });
    Status status;
    forEdges([&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t count = counts(a, b);
        if (count % 2 == 0) return true;
        status = {ErrorCode::VALUE_INVALID,
                  "a surface has no inside: the edge from " + formatTriple(mesh.vertices[a]) +
                      " to " + formatTriple(mesh.vertices[b]) + " belongs to " +
                      std::to_string(count) + (count == 1 ? " triangle" : " triangles")};
        return false;
    });
    return status;
}

std::vector<Plane> convexFaces(const TriangleMesh& mesh, std::size_t most)
{
    std::vector<Plane> planes;
    const Box3d bounds = mesh.bounds();
    const double tolerance = 1e-9 * glm::length(bounds.size());
    const glm::dvec3 middle = bounds.center();
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const glm::dvec3& a = mesh.corner(t, 0);
        const glm::dvec3 normal = glm::cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a);
        const double length = glm::length(normal);
        if (!(length > 0.0)) continue;
        Plane plane;
        plane.normal = normal / length;
        plane.offset = -glm::dot(plane.normal, a);
        if (plane.distance(middle) < 0.0) plane = {-plane.normal, -plane.offset};
        const bool known = std::any_of(planes.begin(), planes.end(), [&](const Plane& p) {
            return glm::dot(p.normal, plane.normal) > 1.0 - 1e-12 &&
                   std::abs(p.distance(a)) <= tolerance;
        });
        if (known) continue;
        for (const glm::dvec3& v : mesh.vertices)
            if (plane.distance(v) < -tolerance) return {};
        if (planes.size() == most) return {};
        planes.push_back(plane);
    }
    return planes;
}

double squaredDistance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                       const glm::dvec3& c)
{
    const auto square = [](const glm::dvec3& v) { return glm::dot(v, v); };
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return square(ap);
    const glm::dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return square(bp);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return square(ap - d1 / (d1 - d3) * ab);
    const glm::dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return square(cp);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return square(ap - d2 / (d2 - d6) * ac);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return square(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
    const double sum = va + vb + vc;
    if (!(std::abs(sum) > 0.0)) return square(ap); // a triangle without area
    return square(ap - vb / sum * ab - vc / sum * ac);
}

} // namespace core
} // namespace osgVolumizer
