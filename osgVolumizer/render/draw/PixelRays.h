#pragma once

#include "../../core/Status.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

namespace osgVolumizer {
namespace render {

/// The rays of all pixels of a view, in a frame of the caller's: origin + t * direction, with t the
/// depth (-z of the eye frame) measured from `referenceDepth`. Both are linear in window
/// coordinates wherever depth alone decides clip w, as in every perspective, orthographic, off-axis
/// and mirrored view.
struct PixelRays
{
    glm::dvec2 windowCenter{0.0}; ///< window coordinates are counted from here, for precision
    glm::dmat3 origin{1.0};       ///< frame; times (dx, dy, 1)
    glm::dmat3 direction{1.0};    ///< frame units per eye unit of depth; times (dx, dy, 1)
    glm::dmat3 originEye{1.0}, directionEye{1.0}; ///< the same, in the eye frame
    glm::dvec3 clipZOrigin{0.0},
        clipZDirection{0.0}; ///< clip z = dot(.., (dx, dy, 1)) + t * dot(..)
    glm::dvec3 clipWOrigin{0.0}, clipWDirection{0.0};
};

/// \param toEye frame -> eye, column-major
/// \param viewport x, y, width, height in pixels
/// \param center frame point whose pixel becomes windowCenter, as far as it lies in the viewport
/// SINGULAR_MATRIX where a matrix cannot be inverted, NOT_SUPPORTED where clip w depends on x or y.
Result<PixelRays> pixelRays(const glm::dmat4& toEye, const glm::dmat4& projection,
                            const glm::dvec4& viewport, double referenceDepth,
                            const glm::dvec3& center);

} // namespace render
} // namespace osgVolumizer
