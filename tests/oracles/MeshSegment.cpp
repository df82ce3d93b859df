#include "MeshSegment.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace osgVolumizer {
namespace oracle {
namespace {

/// Signed distance to the plane of a face along a ray, over that of the corner opposite: a
/// barycentric coordinate, at the ray's parameter t value + t slope.
struct FaceDistance
{
    double value = 0.0;
    double slope = 0.0;
};

// Of a cell's corners in the order of their numbers, so that both cells at a face see the very same
// numbers but for the sign, and the ray leaves one where it enters the other, to the last bit.
// False where the cell has no volume.
bool faceDistances(const TetraMesh& mesh, const TetraMesh::Cell& cell, const glm::dvec3& origin,
                   const glm::dvec3& direction, std::array<FaceDistance, 4>& distances)
{
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return cell[a] < cell[b]; });
    std::array<glm::dvec3, 4> p;
    for (std::size_t i = 0; i < 4; ++i)
        p[i] = mesh.corner(cell, order[i]);
    const double volume = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
    if (volume == 0.0) return false;
    const std::size_t faces[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    const double sides[4] = {-1.0, 1.0, -1.0, 1.0}; // of the opposite corner, where volume > 0
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3& a = p[faces[i][0]];
        const glm::dvec3 normal = glm::cross(p[faces[i][1]] - a, p[faces[i][2]] - a);
        const double sign = volume > 0.0 ? sides[i] : -sides[i];
        distances[order[i]] = {sign * glm::dot(normal, origin - a),
                               sign * glm::dot(normal, direction)};
    }
    return true;
}

// Clamped, for where rounding leaves them outside by a little.
std::array<double, 4> weightsAt(const std::array<FaceDistance, 4>& distances, double t)
{
    std::array<double, 4> weights;
    for (std::size_t i = 0; i < 4; ++i)
        weights[i] = std::max(0.0, distances[i].value + t * distances[i].slope);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& w : weights)
        w = sum > 0.0 ? w / sum : 0.25;
    return weights;
}

bool clip(const std::array<FaceDistance, 4>& distances, MeshSegment& segment)
{
    segment.enter = -std::numeric_limits<double>::infinity();
    segment.leave = -segment.enter;
    for (const FaceDistance& d : distances) {
        if (d.slope == 0.0 && d.value < 0.0) return false;
        if (d.slope > 0.0) segment.enter = std::max(segment.enter, -d.value / d.slope);
        if (d.slope < 0.0) segment.leave = std::min(segment.leave, -d.value / d.slope);
    }
    if (!(segment.enter < segment.leave)) return false;
    segment.enterWeights = weightsAt(distances, segment.enter);
    segment.leaveWeights = weightsAt(distances, segment.leave);
    return true;
}

} // namespace

bool crossCell(const TetraMesh& mesh, std::uint32_t cell, const glm::dvec3& origin,
               const glm::dvec3& direction, MeshSegment& segment)
{
    std::array<FaceDistance, 4> distances;
    segment.cell = cell;
    return faceDistances(mesh, mesh.cells[cell], origin, direction, distances) &&
           clip(distances, segment);
}

MeshSegment partOf(const MeshSegment& segment, double enter, double leave)
{
    MeshSegment part = segment;
    part.enter = enter;
    part.leave = leave;
    const double length = segment.leave - segment.enter;
    const double f0 = (enter - segment.enter) / length, f1 = (leave - segment.enter) / length;
    for (std::size_t i = 0; i < 4; ++i) {
        const double a = segment.enterWeights[i], b = segment.leaveWeights[i];
        part.enterWeights[i] = a + f0 * (b - a);
        part.leaveWeights[i] = a + f1 * (b - a);
    }
    return part;
}

} // namespace oracle
} // namespace osgVolumizer
