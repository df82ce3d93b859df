#include "RayBuffers.h"

#include "../context/TargetBuffers.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

void RayBuffers::release(osg::GLExtensions& gl)
{
    deleteFramebuffers(gl, {&framebuffer});
}

bool ensureRays(osg::State& state, RayBuffers& buffers, int width, int height)
{
    if (buffers.color && buffers.width >= width && buffers.height >= height) return true;
    buffers.width = std::max(width, buffers.width);
    buffers.height = std::max(height, buffers.height);
    buffers.color = makeTarget(state, buffers.width, buffers.height, GL_RGBA32F_ARB);
    if (!buffers.color) {
        buffers.width = buffers.height = 0;
        return false;
    }
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    bindOwn(gl, buffers.framebuffer);
    attach(gl, GL_COLOR_ATTACHMENT0_EXT, textureName(state, *buffers.color));
    return true;
}

} // namespace render
} // namespace osgVolumizer
