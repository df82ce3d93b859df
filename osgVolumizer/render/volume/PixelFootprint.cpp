#include "PixelFootprint.h"

#include "../context/Matrices.h"

#include <osgUtil/CullVisitor>

#include <glm/matrix.hpp>

#include <algorithm>
#include <limits>

namespace osgVolumizer {
namespace render {

glm::dmat2x3 pixelEdges(const glm::dmat4& toEye, double w, osgUtil::CullVisitor& visitor)
{
    const osg::Viewport* viewport = visitor.getViewport();
    if (!viewport || !visitor.getProjectionMatrix()) return glm::dmat2x3(0.0);
    const glm::dmat2 clipToEye = glm::inverse(glm::dmat2(toGlm(*visitor.getProjectionMatrix())));
    const glm::dmat3 fromEye = glm::inverse(glm::dmat3(toEye));
    return {fromEye * glm::dvec3(clipToEye[0] * (2.0 * w / viewport->width()), 0.0),
            fromEye * glm::dvec3(clipToEye[1] * (2.0 * w / viewport->height()), 0.0)};
}

glm::dvec2 clipW(const glm::dmat4& toEye, const core::Box3d& bounds, osgUtil::CullVisitor& visitor)
{
    if (!visitor.getProjectionMatrix()) return glm::dvec2(0.0);
    const glm::dmat4 p = toGlm(*visitor.getProjectionMatrix());
    glm::dvec2 range(std::numeric_limits<double>::infinity(), 0.0);
    for (int i = 0; i < 8; ++i) {
        const double w = p[3][3] + p[2][3] * (toEye * glm::dvec4(bounds.corner(i), 1.0)).z;
        range = {std::min(range.x, w), std::max(range.y, w)};
    }
    return {std::max(range.x, 0.0), range.y};
}

} // namespace render
} // namespace osgVolumizer
