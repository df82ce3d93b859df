#pragma once

#include "Scene.h"

namespace osgVolumizer {
namespace oracle {

/// A ray in the eye frame, parametrised by depth: the point at depth t is origin + t * direction,
/// and direction.z is -1.
struct Ray
{
    glm::dvec3 origin;
    glm::dvec3 direction;
};

/// The ray through window position (x, y).
Ray rayThrough(const Camera& camera, double x, double y);

/// Part of a ray inside a volume's region.
struct Crossing
{
    const Volume* volume = nullptr;
    double enter = 0.0; ///< depths
    double leave = 0.0;
    glm::dvec3 fieldOrigin; ///< the ray in the field frame
    glm::dvec3 fieldDirection;
    glm::dvec3 eyeOrigin; ///< the ray in the eye frame
    glm::dvec3 eyeDirection;
    double objectLength = 0.0; ///< object units per unit of depth
};

/// Crosses a ray with a volume between two depths; false where it misses.
bool cross(const Ray& ray, const Camera& camera, const Volume& volume, Crossing& crossing);

struct Hit
{
    double depth = 0.0;
    glm::dvec4 color; ///< straight
    const Triangle* triangle = nullptr;
};

/// Hits a triangle. Of two triangles that share an edge, exactly one is hit there.
bool hit(const Ray& ray, const Camera& camera, const Triangle& triangle, Hit& result);

} // namespace oracle
} // namespace osgVolumizer
