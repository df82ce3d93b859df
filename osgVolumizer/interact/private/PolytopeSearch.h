#pragma once

#include "VolumeView.h"

#include <vector>

namespace osgVolumizer {
namespace picking {

/// The part of a cell, or of a tetrahedron without voxels, that is inside a polytope and shows
/// something.
struct PolytopeHit
{
    bool found = false;
    std::vector<glm::dvec3> corners; ///< object frame
    glm::dvec3 center{0.0};          ///< their mean
    double distance = 0.0;           ///< of the center from the reference plane
    double farthest = 0.0;           ///< of a corner
    std::uint32_t tetrahedron = 0;
};

/// The nearest one to a plane, by the side that the normal points to. The polytope is that of all
/// half-spaces, object frame, bounded or not. Paged voxels: of a level of which no more bytes are
/// inside than that.
PolytopeHit findInPolytope(const VolumeView& view, const std::vector<core::Plane>& polytope,
                           const core::Plane& reference, std::int64_t maximumBytes);

} // namespace picking
} // namespace osgVolumizer
