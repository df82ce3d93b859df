#pragma once

#include "../Error.h"
#include "../core/geometry/Box.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osg {
class Geometry;
}

namespace osgVolumizer {
namespace slices {

/// What surface a VolumeSlice is, in its object frame, however large the volume. Immutable once
/// made.
struct SliceShape
{
    enum Kind
    {
        EMPTY,
        PLANE,
        POLYGON,
        TRIANGLES
    };
    /// Of a triangle: where it is drawn, and where in the volume it is taken to be.
    struct Corner
    {
        glm::dvec3 position, place;
    };

    Kind kind = EMPTY;
    core::Plane plane; ///< of planes and polygons; the normal has length 1
    std::vector<glm::dvec3> polygon;
    std::vector<Corner> corners; ///< three a triangle
    bool ownPlaces = false;      ///< some place is not the position
};

/// Each is refused as VolumeSlice says.
Result<SliceShape> planeShape(const core::Plane& plane);
Result<SliceShape> polygonShape(const std::vector<glm::dvec3>& polygon);
/// \param placeUnit of the texture coordinates that are places; -1: positions are
Result<SliceShape> triangleShape(const osg::Geometry* geometry, int placeUnit);

} // namespace slices
} // namespace osgVolumizer
