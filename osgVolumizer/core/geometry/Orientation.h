#pragma once

#include "../Export.h"

#include <glm/vec3.hpp>

namespace osgVolumizer {
namespace core {

/// The sign of det(b - a, c - a, d - a): 1, 0 or -1, exact whatever the tetrahedron looks like. A
/// rounded determinant is believed where it is beyond its error bound, else it is evaluated without
/// rounding (Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates", Discrete & Computational Geometry 18, 1997). Expects that no product of three
/// coordinates over- or underflows, rounding errors included (1e-80 to 1e100).
OSGVOLUMIZER_CORE_EXPORT int orientationSign(const glm::dvec3& a, const glm::dvec3& b,
                                             const glm::dvec3& c, const glm::dvec3& d);

} // namespace core
} // namespace osgVolumizer
