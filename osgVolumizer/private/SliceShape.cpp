#include "SliceShape.h"

#include "../core/NumberRule.h"
#include "../core/Text.h"
#include "../core/geometry/ConvexPieces.h"

#include <osg/Geometry>
#include <osg/TriangleIndexFunctor>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <cmath>

namespace osgVolumizer {
namespace slices {

namespace SliceShapes {

Status invalid(const std::string& text, std::int64_t index = -1)
{
    return {ErrorCode::VALUE_INVALID, text, index};
}

bool holds(const glm::dvec3& p)
{
    return core::POSITION.holds(p.x) && core::POSITION.holds(p.y) && core::POSITION.holds(p.z);
}

// The polygon seen along the axis that it is widest across.
std::vector<glm::dvec2> flattened(const std::vector<glm::dvec3>& polygon, const glm::dvec3& normal)
{
    const glm::dvec3 n = glm::abs(normal);
    const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    std::vector<glm::dvec2> result;
    for (const glm::dvec3& p : polygon) {
        const glm::dvec3 q = p - polygon[0];
        result.emplace_back(q[(axis + 1) % 3], q[(axis + 2) % 3]);
    }
    return result;
}

double cross(const glm::dvec2& a, const glm::dvec2& b)
{
    return a.x * b.y - a.y * b.x;
}

// On which side of the line from a to b a point is: -1, 0, 1.
int side(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p)
{
    const double s = cross(b - a, p - a);
    return s > 0.0 ? 1 : s < 0.0 ? -1 : 0;
}

bool isWithin(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p)
{
    return glm::dot(p - a, p - b) <= 0.0;
}

// Whether two edges have a point in common.
bool meet(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d)
{
    const int ac = side(a, b, c), ad = side(a, b, d), ca = side(c, d, a), cb = side(c, d, b);
    if (ac * ad < 0 && ca * cb < 0) return true;
    return (ac == 0 && isWithin(a, b, c)) || (ad == 0 && isWithin(a, b, d)) ||
           (ca == 0 && isWithin(c, d, a)) || (cb == 0 && isWithin(c, d, b));
}

Status checkSimple(const std::vector<glm::dvec2>& p)
{
    const std::size_t n = p.size();
    const auto at = [&p, n](std::size_t i) { return p[i % n]; };
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 ahead = at(i + 1) - p[i], next = at(i + 2) - at(i + 1);
        if (cross(ahead, next) == 0.0 && glm::dot(ahead, next) <= 0.0)
            return invalid("the polygon folds back at corner " + std::to_string((i + 1) % n),
                           std::int64_t((i + 1) % n));
        for (std::size_t k = i + 2; k < n; ++k)
            if ((k + 1) % n != i && meet(p[i], at(i + 1), p[k], at(k + 1)))
                return invalid("the polygon's edges from corners " + std::to_string(i) + " and " +
                                   std::to_string(k) + " cross",
                               std::int64_t(k));
    }
    return {};
}

// Vertices of an array of three components; false for any other, or where one is not finite.
Status takeVertices(const osg::Array* array, const std::string& what,
                    std::vector<glm::dvec3>& vertices)
{
    if (const auto* floats = dynamic_cast<const osg::Vec3Array*>(array)) {
        for (const osg::Vec3& v : *floats)
            vertices.emplace_back(v.x(), v.y(), v.z());
    } else if (const auto* doubles = dynamic_cast<const osg::Vec3dArray*>(array)) {
        for (const osg::Vec3d& v : *doubles)
            vertices.emplace_back(v.x(), v.y(), v.z());
    } else {
        return invalid("the geometry has no " + what + " of three components");
    }
    for (std::size_t i = 0; i < vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!core::POSITION.holds(vertices[i][axis]))
                return invalid("of the geometry's " + what + " number " + std::to_string(i) +
                                   " has " + core::formatNumber(vertices[i][axis]) + ", expected " +
                                   core::POSITION.expected,
                               std::int64_t(i));
    return {};
}

struct CollectCorners
{
    std::vector<unsigned>* indices = nullptr;
    void operator()(unsigned a, unsigned b, unsigned c)
    {
        indices->insert(indices->end(), {a, b, c});
    }
};

} // namespace SliceShapes

Result<SliceShape> planeShape(const core::Plane& plane)
{
    using namespace SliceShapes;
    const double length = glm::length(plane.normal);
    const double offset = plane.offset / length;
    if (!core::LENGTH.holds(length) || !core::POSITION.holds(offset))
        return invalid("the plane's normal has length " + core::formatNumber(length) +
                       " and its offset is " + core::formatNumber(plane.offset) +
                       ", expected a length that is not 0, and finite numbers");
    SliceShape shape;
    shape.kind = SliceShape::PLANE;
    shape.plane = {plane.normal / length, offset};
    return shape;
}

Result<SliceShape> polygonShape(const std::vector<glm::dvec3>& polygon)
{
    using namespace SliceShapes;
    SliceShape shape;
    shape.kind = SliceShape::POLYGON;
    shape.polygon = polygon;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        if (!holds(polygon[i]))
            return invalid("corner " + std::to_string(i) +
                               " of the polygon is beyond 1e18, or not finite",
                           std::int64_t(i));
    std::vector<std::vector<core::Plane>> pieces;
    if (Status s = core::convexPieces(polygon, shape.plane, pieces); !s.ok()) return s;
    if (Status s = checkSimple(flattened(polygon, shape.plane.normal)); !s.ok()) return s;
    return shape;
}

Result<SliceShape> triangleShape(const osg::Geometry* geometry, int placeUnit)
{
    using namespace SliceShapes;
    constexpr int MOST_UNITS = 32;
    if (!geometry) return invalid("there is no geometry");
    if (placeUnit >= MOST_UNITS)
        return invalid("unit " + std::to_string(placeUnit) + " of places is not below " +
                       std::to_string(MOST_UNITS));
    SliceShape shape;
    shape.kind = SliceShape::TRIANGLES;
    shape.ownPlaces = placeUnit >= 0;
    std::vector<glm::dvec3> positions, places;
    if (Status s = takeVertices(geometry->getVertexArray(), "vertices", positions); !s.ok())
        return s;
    if (shape.ownPlaces) {
        const std::string what = "texture coordinates of unit " + std::to_string(placeUnit);
        const osg::Array* array = geometry->getTexCoordArray(unsigned(placeUnit));
        if (Status s = takeVertices(array, what, places); !s.ok()) return s;
        if (places.size() < positions.size())
            return invalid("the geometry has " + std::to_string(places.size()) + " " + what +
                           " for " + std::to_string(positions.size()) + " vertices");
    }
    std::vector<unsigned> indices;
    osg::TriangleIndexFunctor<CollectCorners> collect;
    collect.indices = &indices;
    geometry->accept(collect);
    for (const unsigned i : indices) {
        if (i >= positions.size())
            return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                          "the geometry refers to vertex " + std::to_string(i) + ", of " +
                              std::to_string(positions.size()),
                          i);
        shape.corners.push_back({positions[i], shape.ownPlaces ? places[i] : positions[i]});
    }
    if (shape.corners.empty()) return invalid("the geometry has no triangles");
    return shape;
}

} // namespace slices
} // namespace osgVolumizer
