#include "Measure.h"

#include "../VolumeGeometry.h"
#include "../Voxels.h"
#include "../core/Text.h"
#include "../core/geometry/TetraMesh.h"
#include "../core/voxels/VoxelData.h"
#include "private/GlmToOsg.h"
#include "private/RegionSpans.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace osgVolumizer {

namespace {

Status checkPoints(const std::vector<osg::Vec3d>& points, const char* what)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!std::isfinite(points[i].x() + points[i].y() + points[i].z()))
            return {ErrorCode::VALUE_INVALID,
                    std::string(what) + " " + std::to_string(i) + " is " +
                        core::formatTriple(picking::toGlm(points[i])) + ", which is not finite",
                    static_cast<std::int64_t>(i)};
    return {};
}

// Twice the area, along the normal; about the first corner, so that nothing cancels far away.
osg::Vec3d areaVector(const std::vector<osg::Vec3d>& corners)
{
    osg::Vec3d sum;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += (corners[i] - corners[0]) ^ (corners[i + 1] - corners[0]);
    return sum;
}

double sizeOf(const std::vector<osg::Vec3d>& corners)
{
    double size = 0.0;
    for (const osg::Vec3d& c : corners)
        size = std::max(size, (c - corners[0]).length());
    return size;
}

// The normal of the plane through corners, of length 1; 0 where they lie on a line.
osg::Vec3d planeNormal(const std::vector<osg::Vec3d>& corners, double size)
{
    // The area of a polygon that crosses itself may be 0: by the corner farthest from a line.
    osg::Vec3d best;
    std::size_t far = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if ((corners[i] - corners[0]).length() > (corners[far] - corners[0]).length()) far = i;
    for (const osg::Vec3d& c : corners) {
        const osg::Vec3d n = (corners[far] - corners[0]) ^ (c - corners[0]);
        if (n.length() > best.length()) best = n;
    }
    if (best.length() <= 1e-12 * size * size) return {};
    best.normalize();
    return best;
}

double side(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool between(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p)
{
    return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
           p.y <= std::max(a.y, b.y);
}

// Whether two closed segments have a point in common.
bool meet(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d)
{
    const double c0 = side(a, b, c), d0 = side(a, b, d), a0 = side(c, d, a), b0 = side(c, d, b);
    if (((c0 > 0.0 && d0 < 0.0) || (c0 < 0.0 && d0 > 0.0)) &&
        ((a0 > 0.0 && b0 < 0.0) || (a0 < 0.0 && b0 > 0.0)))
        return true;
    return (c0 == 0.0 && between(a, b, c)) || (d0 == 0.0 && between(a, b, d)) ||
           (a0 == 0.0 && between(c, d, a)) || (b0 == 0.0 && between(c, d, b));
}

std::vector<glm::dvec2> flattened(const std::vector<osg::Vec3d>& corners, const osg::Vec3d& normal)
{
    int axis = 0; // that the normal is nearest to
    for (int a = 1; a < 3; ++a)
        if (std::fabs(normal[a]) > std::fabs(normal[axis])) axis = a;
    std::vector<glm::dvec2> flat;
    for (const osg::Vec3d& c : corners) {
        const osg::Vec3d p = c - corners[0];
        flat.emplace_back(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    }
    return flat;
}

Status checkEdges(const std::vector<glm::dvec2>& p)
{
    const std::size_t n = p.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            const std::size_t i1 = (i + 1) % n, j1 = (j + 1) % n;
            // Neighbours share a corner, and may not fold back on one another.
            bool crosses = false;
            if (i1 == j || j1 == i) {
                const glm::dvec2 &shared = i1 == j ? p[j] : p[i], &before = i1 == j ? p[i] : p[j];
                const glm::dvec2& after = i1 == j ? p[j1] : p[i1];
                crosses = side(before, shared, after) == 0.0 &&
                          glm::dot(before - shared, after - shared) > 0.0;
            } else {
                crosses = meet(p[i], p[i1], p[j], p[j1]);
            }
            if (crosses)
                return {ErrorCode::VALUE_INVALID,
                        "a polygon crosses itself: edge " + std::to_string(i) + " meets edge " +
                            std::to_string(j),
                        static_cast<std::int64_t>(i)};
        }
    return {};
}

Status checkPolygon(const std::vector<osg::Vec3d>& corners)
{
    constexpr std::size_t MANY = 4096;
    if (corners.size() < 3)
        return {ErrorCode::VALUE_INVALID,
                "a polygon has " + std::to_string(corners.size()) + " corners, expected 3 or more"};
    if (corners.size() > MANY)
        return {ErrorCode::TOO_LARGE, "a polygon has " + std::to_string(corners.size()) +
                                          " corners, expected no more than 4096"};
    if (Status status = checkPoints(corners, "corner"); !status.ok()) return status;
    const double size = sizeOf(corners);
    const osg::Vec3d normal = planeNormal(corners, size);
    if (!(normal.length() > 0.0))
        return {ErrorCode::VALUE_INVALID, "the corners of a polygon lie on a line"};
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (!(std::fabs((corners[i] - corners[0]) * normal) <= 1e-6 * size))
            return {ErrorCode::VALUE_INVALID,
                    "corner " + std::to_string(i) + " of a polygon is off the plane of the others",
                    static_cast<std::int64_t>(i)};
    return checkEdges(flattened(corners, normal));
}

using Inside = std::function<bool(const glm::dvec3& voxel)>;

// Whether the middle of a voxel is in a region; empty for all of space.
Result<Inside> insideOf(const VolumeGeometry* geometry, const Voxels& voxels)
{
    if (!geometry) return Inside();
    const auto region = picking::pickRegion(*geometry, &voxels);
    if (!region) return Inside([](const glm::dvec3&) { return false; });
    if (!region->prepared().voxelFrame)
        return Status(ErrorCode::NOT_SUPPORTED, "VolumeGeometry \"" + geometry->getName() +
                                                    "\" is deformed: voxels in it differ in size");
    if (region->prepared().region)
        return Inside(
            [region](const glm::dvec3& p) { return region->prepared().region->contains(p); });
    const auto locator = std::make_shared<core::PointLocator>(region->prepared().tetras);
    return Inside(
        [region, locator](const glm::dvec3& p) { return locator->locate(p).has_value(); });
}

// Samples of a brick that no brick before it has, and that count.
std::int64_t countSamples(const Voxels& voxels, std::int64_t brick, double low, double high,
                          const Inside& inside)
{
    const auto range = voxels.getBrickRange(brick);
    if (!(range.first <= high && range.second >= low)) return 0;
    const VoxelBlock block = voxels.getBrick(brick);
    if (!block) return 0;
    const core::BrickLayout& layout = voxels.getLayout();
    const core::Box3i samples = layout.brick(brick).samples;
    const glm::ivec3 coordinates = layout.coordinates(brick);
    const core::VoxelView view{block.data, voxels.getType(), voxels.getComponents(),
                               samples.size()};
    glm::ivec3 first(0), p; // not of the brick before
    for (int a = 0; a < 3; ++a)
        if (coordinates[a] > 0) {
            glm::ivec3 before = coordinates;
            --before[a];
            first[a] = layout.brick(layout.index(before)).samples.max[a] - samples.min[a];
        }
    std::int64_t count = 0;
    for (p.z = first.z; p.z < view.size.z; ++p.z)
        for (p.y = first.y; p.y < view.size.y; ++p.y)
            for (p.x = first.x; p.x < view.size.x; ++p.x) {
                const std::int64_t i =
                    p.x + std::int64_t(view.size.x) * (p.y + std::int64_t(view.size.y) * p.z);
                const double value = core::voxelValue(view, i, view.components == 4 ? 3 : 0);
                if (value >= low && value <= high &&
                    (!inside || inside(glm::dvec3(samples.min + p))))
                    ++count;
            }
    return count;
}

} // namespace

Result<double> polylineLength(const std::vector<osg::Vec3d>& points)
{
    if (Status status = checkPoints(points, "point"); !status.ok()) return status;
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i)
        length += (points[i] - points[i - 1]).length();
    return length;
}

Result<double> angleAt(const osg::Vec3d& apex, const osg::Vec3d& a, const osg::Vec3d& b)
{
    if (Status status = checkPoints({apex, a, b}, "point"); !status.ok()) return status;
    osg::Vec3d u = a - apex, v = b - apex;
    if (!(u.normalize() > 0.0) || !(v.normalize() > 0.0))
        return Status(ErrorCode::VALUE_INVALID, "an angle has no direction: a point is its apex");
    return std::atan2((u ^ v).length(), u * v);
}

Result<double> polygonArea(const std::vector<osg::Vec3d>& corners)
{
    if (Status status = checkPolygon(corners); !status.ok()) return status;
    return 0.5 * areaVector(corners).length();
}

double tetraVolume(const VolumeGeometry& geometry, const osg::Matrixd& toWorld)
{
    const osg::Vec3d x = osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), toWorld);
    const osg::Vec3d y = osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), toWorld);
    const osg::Vec3d z = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), toWorld);
    return std::fabs((x ^ y) * z) * core::volume(*geometry.getTetraSet());
}

Result<double> valueVolume(const Voxels& voxels, double low, double high,
                           const VolumeGeometry* geometry)
{
    if (!voxels.valid()) return Status(ErrorCode::VALUE_INVALID, "there are no voxels to count");
    if (!(low <= high))
        return Status(ErrorCode::VALUE_INVALID, "values from " + core::formatNumber(low) + " to " +
                                                    core::formatNumber(high) + " are no range");
    if (voxels.isPaged())
        return Status(ErrorCode::NOT_SUPPORTED,
                      "voxels that are paged are not counted: all of them would be read");
    const Result<Inside> inside = insideOf(geometry, voxels);
    if (!inside.ok()) return inside.status;
    std::int64_t count = 0;
    for (std::int64_t brick = 0; brick < voxels.getLayout().brickCount(); ++brick)
        count += countSamples(voxels, brick, low, high, *inside);
    const osg::Vec3d s = voxels.getSpacing();
    return static_cast<double>(count) * s.x() * s.y() * s.z();
}

} // namespace osgVolumizer
