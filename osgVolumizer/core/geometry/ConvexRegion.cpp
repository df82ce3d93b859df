#include "ConvexRegion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double RELATIVE = 1e-9;
/// More planes than this serve nobody: they would be evaluated for every pixel.
constexpr std::size_t MAX_PLANES = 4096;

/// One number per distinct position.
std::vector<std::uint32_t> mergePositions(const TetraSet& set)
{
    std::vector<std::uint32_t> byPosition(set.vertices.size());
    std::iota(byPosition.begin(), byPosition.end(), 0u);
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
        const glm::dvec3 p = set.vertices.position(a), q = set.vertices.position(b);
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    std::sort(byPosition.begin(), byPosition.end(), less);
    std::vector<std::uint32_t> merged(byPosition.size());
    for (std::size_t i = 0; i < byPosition.size(); ++i)
        merged[byPosition[i]] = i > 0 && !less(byPosition[i - 1], byPosition[i])
                                    ? merged[byPosition[i - 1]]
                                    : byPosition[i];
    return merged;
}

struct Face
{
    std::array<std::uint32_t, 3> sorted; ///< vertices, ascending
    std::array<std::uint32_t, 3> vertex; ///< clockwise seen from outside: the normal points inwards
    bool odd;                            ///< whether `vertex` is an odd permutation of `sorted`
};

Face makeFace(std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    Face f{{a, b, c}, {a, b, c}, false};
    const auto order = [&](int i, int j) {
        if (f.sorted[std::size_t(i)] <= f.sorted[std::size_t(j)]) return;
        std::swap(f.sorted[std::size_t(i)], f.sorted[std::size_t(j)]);
        f.odd = !f.odd;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return f;
}

/// Faces of all tetrahedra with volume, normals inwards; adds up the volume.
std::vector<Face> inwardFaces(const TetraSet& set, double& volume)
{
    const std::vector<std::uint32_t> merged = mergePositions(set);
    std::vector<Face> faces;
    faces.reserve(set.indices.size());
    for (std::size_t i = 0; i < set.indices.size(); i += 4) {
        std::uint32_t t[4];
        for (std::size_t k = 0; k < 4; ++k)
            t[k] = merged[set.indices[i + k]];
        const glm::dvec3 a = set.vertices.position(t[0]);
        const double six =
            glm::dot(glm::cross(set.vertices.position(t[1]) - a, set.vertices.position(t[2]) - a),
                     set.vertices.position(t[3]) - a);
        if (six == 0.0) continue;
        volume += std::abs(six) / 6.0;
        if (six < 0.0) std::swap(t[0], t[1]);
        faces.push_back(makeFace(t[0], t[1], t[2]));
        faces.push_back(makeFace(t[0], t[2], t[3]));
        faces.push_back(makeFace(t[0], t[3], t[1]));
        faces.push_back(makeFace(t[1], t[3], t[2]));
    }
    return faces;
}

/// Leaves the faces that belong to one tetrahedron; false if a face has two on the same side, or
/// more than two.
bool keepBoundary(std::vector<Face>& faces)
{
    std::sort(faces.begin(), faces.end(),
              [](const Face& a, const Face& b) { return a.sorted < b.sorted; });
    std::vector<Face> boundary;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t j = i + 1;
        while (j < faces.size() && faces[j].sorted == faces[i].sorted)
            ++j;
        if (j - i > 2 || (j - i == 2 && faces[i].odd == faces[i + 1].odd)) return false;
        if (j - i == 1) boundary.push_back(faces[i]);
        i = j;
    }
    faces.swap(boundary);
    return true;
}

/// The face's plane, relative to `center`.
bool planeOf(const TetraSet& set, const Face& f, const glm::dvec3& center, Plane& plane)
{
    const glm::dvec3 a = set.vertices.position(f.vertex[0]) - center;
    const glm::dvec3 b = set.vertices.position(f.vertex[1]) - center;
    const glm::dvec3 c = set.vertices.position(f.vertex[2]) - center;
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    if (!(length > 0.0)) return false;
    plane.normal = n / length;
    plane.offset = -glm::dot(plane.normal, (a + b + c) / 3.0);
    return true;
}

} // namespace

std::optional<ConvexRegion> convexRegion(const TetraSet& set)
{
    double volume = 0.0;
    std::vector<Face> faces = inwardFaces(set, volume);
    if (faces.empty() || !std::isfinite(volume) || !keepBoundary(faces)) return std::nullopt;

    ConvexRegion region;
    region.bounds = set.bounds();
    const glm::dvec3 center = region.bounds.center();
    const double tolerance = RELATIVE * glm::length(region.bounds.size());
    const auto known = [&](const Plane& p) {
        return std::any_of(region.planes.begin(), region.planes.end(), [&](const Plane& q) {
            return glm::length(p.normal - q.normal) <= RELATIVE * 100.0 &&
                   std::abs(p.offset - q.offset) <= tolerance * 10.0;
        });
    };
    for (const Face& f : faces) {
        Plane plane;
        if (!planeOf(set, f, center, plane)) return std::nullopt;
        if (known(plane)) continue;
        for (const TetraSet::Index i : set.indices)
            if (plane.distance(set.vertices.position(i) - center) < -tolerance) return std::nullopt;
        region.planes.push_back(plane);
        if (region.planes.size() > MAX_PLANES) return std::nullopt;
    }
    // The hull, in coordinates about the centre, from a box that is a little too large.
    ConvexPolytope hull;
    const glm::dvec3 half = 0.5 * region.bounds.size() + glm::dvec3(tolerance * 1e3);
    hull.setBox({-half, half});
    clipPolytope(hull, region, 6);
    if (!(std::abs(hull.volume() - volume) <= 1e-6 * volume)) return std::nullopt;
    for (Plane& p : region.planes)
        p.offset -= glm::dot(p.normal, center);
    return region;
}

void clipPolytope(ConvexPolytope& polytope, const ConvexRegion& region, int firstTag)
{
    for (std::size_t i = 0; i < region.planes.size(); ++i)
        polytope.clip(region.planes[i], firstTag + static_cast<int>(i));
}

} // namespace core
} // namespace osgVolumizer
