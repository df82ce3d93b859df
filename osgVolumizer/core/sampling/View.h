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

    bool operator==(const View& o) const { return toEye == o.toEye && projection == o.projection; }
};

} // namespace core
} // namespace osgVolumizer
