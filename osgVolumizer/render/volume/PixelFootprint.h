#pragma once

#include "../../core/geometry/Box.h"

#include <glm/mat2x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// Frame units that a pixel's width and height cover where clip w is `w`; zero where the view has
/// no viewport. \param toEye frame to eye
glm::dmat2x3 pixelEdges(const glm::dmat4& toEye, double w, osgUtil::CullVisitor& visitor);

/// Lowest (not below 0) and highest clip w of a box.
glm::dvec2 clipW(const glm::dmat4& toEye, const core::Box3d& bounds, osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
