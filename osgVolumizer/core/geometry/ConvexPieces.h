#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Box.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osgVolumizer {
namespace core {

/// Cuts a simple polygon, planar to 1e-6 of its size, into convex pieces: itself, or triangles by
/// ear clipping (Meisters, "Polygons have ears", 1975). Each piece is a set of half-spaces whose
/// planes stand upright on the polygon's; two pieces that share an edge have exactly opposite
/// planes there. \param plane receives the polygon's plane; the polygon runs counter-clockwise
/// about its normal VALUE_INVALID for fewer than three corners, no area, or corners off the plane
/// or not finite; TOO_LARGE for more than 1024 corners.
OSGVOLUMIZER_CORE_EXPORT Status convexPieces(const std::vector<glm::dvec3>& polygon, Plane& plane,
                                             std::vector<std::vector<Plane>>& pieces);

} // namespace core
} // namespace osgVolumizer
