#include "AccumulationBuffers.h"

#include "../context/TargetBuffers.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

void AccumulationBuffers::release(osg::GLExtensions& gl)
{
    deleteFramebuffers(gl, {&framebuffer, &splitFramebuffer, &opaqueFramebuffer});
}

bool ensureOpaqueDepth(osg::State& state, AccumulationBuffers& buffers, int width, int height,
                       GLenum depthFormat)
{
    if (buffers.opaqueDepth && buffers.width >= width && buffers.height >= height &&
        buffers.depthFormat == depthFormat)
        return true;
    buffers.width = std::max(width, buffers.width);
    buffers.height = std::max(height, buffers.height);
    buffers.depthFormat = depthFormat;
    buffers.color = buffers.splitDepth = nullptr;
    buffers.opaqueDepth = makeTarget(state, buffers.width, buffers.height, depthFormat);
    if (!buffers.opaqueDepth) {
        buffers.width = buffers.height = 0; // the next view may be smaller
        return false;
    }
    bindDepthOnly(state, buffers.opaqueFramebuffer, *buffers.opaqueDepth, depthFormat);
    return true;
}

bool ensureTarget(osg::State& state, AccumulationBuffers& buffers,
                  const std::vector<GLenum>& colorFormats)
{
    if (buffers.color && buffers.askedFormat == colorFormats.front()) return true;
    if (!buffers.opaqueDepth) return false;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    buffers.depth = makeTarget(state, buffers.width, buffers.height, buffers.depthFormat);
    if (!buffers.depth) return false;
    buffers.askedFormat = colorFormats.front();
    for (GLenum format : colorFormats) {
        buffers.colorFormat = format;
        buffers.color = makeTarget(state, buffers.width, buffers.height, format);
        if (!buffers.color) continue;
        ++buffers.colorCount;
        bindOwn(gl, buffers.framebuffer);
        attach(gl, GL_COLOR_ATTACHMENT0_EXT, textureName(state, *buffers.color));
        attachDepth(gl, textureName(state, *buffers.depth), buffers.depthFormat);
        if (gl.glCheckFramebufferStatus(GL_FRAMEBUFFER_EXT) == GL_FRAMEBUFFER_COMPLETE_EXT)
            return true;
        buffers.color = nullptr;
    }
    return false;
}

bool ensureSplitDepth(osg::State& state, AccumulationBuffers& buffers)
{
    if (buffers.splitDepth) return true;
    buffers.splitDepth = makeTarget(state, buffers.width, buffers.height, buffers.depthFormat);
    if (!buffers.splitDepth) return false;
    bindDepthOnly(state, buffers.splitFramebuffer, *buffers.splitDepth, buffers.depthFormat);
    return true;
}

void attachTargetColor(osg::State& state, GLuint framebuffer, const AccumulationBuffers& buffers,
                       unsigned& attachedCount)
{
    if (attachedCount == buffers.colorCount) return;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffer);
    attach(gl, GL_COLOR_ATTACHMENT0_EXT, textureName(state, *buffers.color));
    attachedCount = buffers.colorCount;
}

} // namespace render
} // namespace osgVolumizer
