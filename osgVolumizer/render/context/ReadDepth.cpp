#include "ReadDepth.h"

#include "GLErrors.h"

#include <cmath>

namespace osgVolumizer {
namespace render {

std::optional<double> readDepth(osg::State& state, const osg::Viewport& viewport, double x,
                                double y)
{
    if (!(x >= 0.0 && y >= 0.0 && x < viewport.width() && y < viewport.height()))
        return std::nullopt;
    discardErrors();
    GLint alignment = 4, buffer = 0;
    glGetIntegerv(GL_PACK_ALIGNMENT, &alignment);
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer);
    if (buffer) gl.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    GLfloat depth = -1.0f;
    glReadPixels(static_cast<GLint>(std::floor(viewport.x() + x)),
                 static_cast<GLint>(std::floor(viewport.y() + y)), 1, 1, GL_DEPTH_COMPONENT,
                 GL_FLOAT, &depth);
    glPixelStorei(GL_PACK_ALIGNMENT, alignment);
    if (buffer) gl.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, GLuint(buffer));
    if (glGetError() != GL_NO_ERROR || !(depth >= 0.0f && depth <= 1.0f)) return std::nullopt;
    return depth;
}

} // namespace render
} // namespace osgVolumizer
