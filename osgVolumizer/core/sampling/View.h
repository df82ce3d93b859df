#pragma once

#include <glm/mat4x4.hpp>

namespace osgVolumizer {
namespace core {

/// A view of a tetra set: column-major matrices as in GLM. `toEye` maps the positions of the tetra
/// set to the eye frame (looking down -z); depth is -z. `projection` maps the eye frame to clip
/// coordinates, as in OpenGL.
struct View
{
    glm::dmat4 toEye{1.0};
    glm::dmat4 projection{1.0};

    /// How depth grows along each axis of the positions: the third row of `toEye`, negated.
    glm::dvec3 depthGradient() const { return {-toEye[0][2], -toEye[1][2], -toEye[2][2]}; }

    bool operator==(const View& o) const { return toEye == o.toEye && projection == o.projection; }
};

} // namespace core
} // namespace osgVolumizer
