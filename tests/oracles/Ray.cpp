#include "Ray.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <tuple>

namespace osgVolumizer {
namespace oracle {

Ray rayThrough(const Camera& camera, double x, double y)
{
    const double ndc[2] = {2.0 * x / camera.width - 1.0, 2.0 * y / camera.height - 1.0};
    // The ray is where two planes of the eye frame meet: clip.x - ndc.x clip.w = 0, and so for y.
    const glm::dmat4 p = glm::transpose(camera.projection);
    const glm::dvec4 plane[2] = {p[0] - ndc[0] * p[3], p[1] - ndc[1] * p[3]};
    const glm::dvec3 n0(plane[0]), n1(plane[1]);
    Ray ray;
    ray.direction = glm::cross(n0, n1);
    ray.direction /= -ray.direction.z;
    // Its point at z = 0.
    const double d = n0.x * n1.y - n0.y * n1.x;
    ray.origin = glm::dvec3((n0.y * plane[1].w - n1.y * plane[0].w) / d,
                            (n1.x * plane[0].w - n0.x * plane[1].w) / d, 0.0);
    return ray;
}

bool cross(const Ray& ray, const Camera& camera, const Volume& volume, Crossing& crossing)
{
    const glm::dmat4 toObject = glm::inverse(camera.view * volume.objectToWorld);
    const glm::dvec3 origin(toObject * glm::dvec4(ray.origin, 1.0));
    const glm::dvec3 direction(toObject * glm::dvec4(ray.direction, 0.0));
    double enter = camera.nearDepth, leave = camera.farDepth;
    for (const core::Plane& plane : volume.region) {
        const double distance = plane.distance(origin);
        const double slope = glm::dot(plane.normal, direction);
        if (slope == 0.0 && distance < 0.0) return false;
        if (slope > 0.0) enter = std::max(enter, -distance / slope);
        if (slope < 0.0) leave = std::min(leave, -distance / slope);
    }
    if (!(enter < leave) || !std::isfinite(enter) || !std::isfinite(leave)) return false;
    crossing.volume = &volume;
    crossing.enter = enter;
    crossing.leave = leave;
    crossing.fieldOrigin = glm::dvec3(volume.objectToField * glm::dvec4(origin, 1.0));
    crossing.fieldDirection = glm::dvec3(volume.objectToField * glm::dvec4(direction, 0.0));
    crossing.eyeOrigin = ray.origin;
    crossing.eyeDirection = ray.direction;
    crossing.objectLength = glm::length(direction);
    return true;
}

namespace {

bool before(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// Six times the signed volume that the ray spans with edge a-b. Swapping a and b flips the sign
// exactly, so that triangles which share the edge agree about its sides.
double side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& direction)
{
    return glm::dot(direction, glm::cross(a, b));
}

} // namespace

bool hit(const Ray& ray, const Camera& camera, const Triangle& triangle, Hit& result)
{
    glm::dvec3 p[3];
    for (int i = 0; i < 3; ++i)
        p[i] = glm::dvec3(camera.view * glm::dvec4(triangle.corner[i], 1.0)) - ray.origin;
    double w[3];
    for (int i = 0; i < 3; ++i)
        w[i] = side(p[(i + 1) % 3], p[(i + 2) % 3], ray.direction);
    const double sum = w[0] + w[1] + w[2];
    if (sum == 0.0) return false; // seen edge on, or degenerate
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
        // On the edge: it belongs to the triangle on one side, by an order of the corners that its
        // neighbour sees the other way round.
        const bool inside = w[i] != 0.0 ? (w[i] > 0.0) == (sum > 0.0) : before(a, b) == (sum > 0.0);
        if (!inside) return false;
    }
    double depth = 0.0;
    result.color = glm::dvec4(0.0);
    for (int i = 0; i < 3; ++i) {
        depth -= w[i] / sum * (p[i].z + ray.origin.z);
        result.color += w[i] / sum * triangle.color[i];
    }
    result.depth = depth;
    result.triangle = &triangle;
    return depth > camera.nearDepth && depth < camera.farDepth;
}

} // namespace oracle
} // namespace osgVolumizer
