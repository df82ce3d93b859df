#include "Polyhedra.h"

#include <vtkIdTypeArray.h>
#include <vtkUnstructuredGrid.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace osgVolumizer {
namespace vtk {

namespace {

using Index = GridVertices::Index;

constexpr double FLATNESS = 1e-6; ///< of what counts as one face, in sizes of the hull

// Six times the volume.
double volumeOf(const GridVertices& vertices, const glm::dvec3& a, const Index* others)
{
    const glm::dvec3 b = vertices.position(others[0]) - a, c = vertices.position(others[1]) - a,
                     d = vertices.position(others[2]) - a;
    return std::abs(glm::dot(b, glm::cross(c, d)));
}

// Three corners each.
std::vector<Index> fansOf(const std::vector<Polygon>& faces)
{
    std::vector<Index> triangles;
    for (const Polygon& face : faces) {
        const std::size_t n = face.size();
        const auto lowest =
            static_cast<std::size_t>(std::min_element(face.begin(), face.end()) - face.begin());
        for (std::size_t i = 1; i + 1 < n; ++i)
            triangles.insert(triangles.end(),
                             {face[lowest], face[(lowest + i) % n], face[(lowest + i + 1) % n]});
    }
    return triangles;
}

// The corners of a face in the order of their angles about its middle.
Polygon ringOf(const std::vector<Index>& corners, const glm::dvec3& normal,
               const GridVertices& vertices)
{
    glm::dvec3 middle(0.0);
    for (const Index corner : corners)
        middle += vertices.position(corner) / static_cast<double>(corners.size());
    const glm::dvec3 u = vertices.position(corners[0]) - middle, v = glm::cross(normal, u);
    std::vector<std::pair<double, Index>> byAngle;
    for (const Index corner : corners) {
        const glm::dvec3 d = vertices.position(corner) - middle;
        byAngle.emplace_back(std::atan2(glm::dot(d, v), glm::dot(d, u)), corner);
    }
    std::sort(byAngle.begin(), byAngle.end());
    Polygon ring;
    for (const auto& [angle, corner] : byAngle)
        ring.push_back(corner);
    return ring;
}

// The points in the plane of three; empty where points lie on both sides of it.
std::vector<Index> pointsInPlane(const std::vector<Index>& points, const glm::dvec3& place,
                                 const glm::dvec3& normal, double tolerance,
                                 const GridVertices& vertices)
{
    std::vector<Index> in;
    bool above = false, below = false;
    for (const Index point : points) {
        const double height = glm::dot(vertices.position(point) - place, normal);
        above = above || height > tolerance;
        below = below || height < -tolerance;
        if (std::abs(height) <= tolerance) in.push_back(point);
    }
    return above && below ? std::vector<Index>() : in;
}

} // namespace

void splitPolyhedron(const std::vector<Polygon>& faces, GridVertices& vertices,
                     std::vector<Index>& indices)
{
    const std::vector<Index> triangles = fansOf(faces);
    if (triangles.empty()) return;
    std::set<Index> corners;
    for (const Polygon& face : faces)
        corners.insert(face.begin(), face.end());
    GridVertices::Terms mean;
    glm::dvec3 center(0.0);
    const double weight = 1.0 / static_cast<double>(corners.size());
    for (const Index corner : corners) {
        mean.emplace_back(corner, weight);
        center += weight * vertices.position(corner);
    }
    // Whatever an apex does not see is counted too often.
    Index apex = *corners.begin();
    double fromCorner = 0.0, fromCenter = 0.0;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        fromCorner += volumeOf(vertices, vertices.position(apex), &triangles[t]);
        fromCenter += volumeOf(vertices, center, &triangles[t]);
    }
    if (fromCorner > fromCenter * (1.0 + 1e-9)) apex = vertices.add(mean);
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        const Index* a = &triangles[t];
        if (a[0] != apex) indices.insert(indices.end(), {a[0], a[1], a[2], apex});
    }
}

std::vector<Polygon> facesOfHull(const std::vector<Index>& points, const GridVertices& vertices)
{
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const Index point : points) {
        low = glm::min(low, vertices.position(point));
        high = glm::max(high, vertices.position(point));
    }
    const double size = glm::length(high - low);
    std::vector<Polygon> faces;
    std::set<std::vector<Index>> known;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t k = 0; k < j; ++k) {
                const glm::dvec3 a = vertices.position(points[i]);
                const glm::dvec3 normal =
                    glm::cross(vertices.position(points[j]) - a, vertices.position(points[k]) - a);
                const double length = glm::length(normal);
                if (!(length > FLATNESS * size * size)) continue;
                std::vector<Index> in =
                    pointsInPlane(points, a, normal / length, FLATNESS * size, vertices);
                std::sort(in.begin(), in.end());
                if (in.size() >= 3 && known.insert(in).second)
                    faces.push_back(ringOf(in, normal / length, vertices));
            }
    return faces;
}

std::vector<Polygon> facesOfPrism(const std::vector<Index>& points)
{
    const std::size_t n = points.size() / 2;
    const auto top = points.begin() + static_cast<std::ptrdiff_t>(n);
    std::vector<Polygon> faces{Polygon(points.begin(), top), Polygon(top, points.end())};
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t next = (i + 1) % n;
        faces.push_back({points[i], points[next], points[n + next], points[n + i]});
    }
    return faces;
}

// A face stream is the number of faces, and for each the number of its points and these.
Result<std::vector<Polygon>> facesOfPolyhedron(vtkUnstructuredGrid& grid, vtkIdType cell)
{
    std::vector<Polygon> faces;
    const Status bad(
        ErrorCode::INDEX_OUT_OF_RANGE,
        "the faces of cell " + std::to_string(cell) + " are not stated as they should be", cell);
    vtkIdTypeArray *stream = grid.GetFaces(), *starts = grid.GetFaceLocations();
    if (!stream || !starts || starts->GetNumberOfValues() <= cell) return bad;
    vtkIdType at = starts->GetValue(cell);
    const vtkIdType end = stream->GetNumberOfValues();
    const auto next = [&](vtkIdType limit, vtkIdType& value) {
        if (at < 0 || at >= end) return false;
        value = stream->GetValue(at++);
        return value >= 0 && value < limit;
    };
    vtkIdType count = 0, corners = 0, corner = 0;
    if (!next(end, count)) return bad;
    for (vtkIdType f = 0; f < count; ++f) {
        if (!next(end, corners)) return bad;
        Polygon face;
        for (vtkIdType i = 0; i < corners; ++i) {
            if (!next(grid.GetNumberOfPoints(), corner)) return bad;
            face.push_back(static_cast<Index>(corner));
        }
        faces.push_back(std::move(face));
    }
    return faces;
}

} // namespace vtk
} // namespace osgVolumizer
