#pragma once

#include <glm/vec3.hpp>

#include <limits>

namespace osgVolumizer {
namespace core {

/// Axis-aligned box of doubles, in whatever frame its owner says. Half-open [min, max) when points
/// are assigned to neighbouring boxes. Empty while min > max on any axis.
struct Box3d
{
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    glm::dvec3 size() const { return max - min; }
    glm::dvec3 center() const { return 0.5 * (min + max); }
    void expand(const glm::dvec3& p)
    {
        min = glm::dvec3(p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y,
                         p.z < min.z ? p.z : min.z);
        max = glm::dvec3(p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y,
                         p.z > max.z ? p.z : max.z);
    }
    /// Corner i: bit 0 selects max.x, bit 1 max.y, bit 2 max.z.
    glm::dvec3 corner(int i) const
    {
        return {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z};
    }
    bool operator==(const Box3d& o) const { return min == o.min && max == o.max; }
};

/// Box of integers, half-open: [min, max) on each axis. Used for ranges of samples and of cells.
struct Box3i
{
    glm::ivec3 min{0};
    glm::ivec3 max{0};

    glm::ivec3 size() const { return max - min; }
    bool empty() const { return max.x <= min.x || max.y <= min.y || max.z <= min.z; }
    bool operator==(const Box3i& o) const { return min == o.min && max == o.max; }
};

namespace detail {

template <class Box>
Box intersection(const Box& a, const Box& b)
{
    Box r;
    for (int i = 0; i < 3; ++i) {
        r.min[i] = a.min[i] > b.min[i] ? a.min[i] : b.min[i];
        r.max[i] = a.max[i] < b.max[i] ? a.max[i] : b.max[i];
    }
    return r;
}

} // namespace detail

/// The overlap of two boxes; empty where they do not touch.
inline Box3d intersection(const Box3d& a, const Box3d& b)
{
    return detail::intersection(a, b);
}
/// The overlap of two ranges; empty where they have nothing in common.
inline Box3i intersection(const Box3i& a, const Box3i& b)
{
    return detail::intersection(a, b);
}

/// Half-space: the points p with dot(normal, p) + offset >= 0.
struct Plane
{
    glm::dvec3 normal{0.0, 0.0, 1.0};
    double offset = 0.0;

    double distance(const glm::dvec3& p) const
    {
        return normal.x * p.x + normal.y * p.y + normal.z * p.z + offset;
    }
};

} // namespace core
} // namespace osgVolumizer
