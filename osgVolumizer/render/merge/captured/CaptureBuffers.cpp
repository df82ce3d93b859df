#include "CaptureBuffers.h"

#include "../../context/TargetBuffers.h"

#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

// Gives the framebuffers of slots their textures of the arrays.
void attachSlots(osg::State& state, CaptureBuffers& buffers)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const GLuint colors = textureName(state, *buffers.colors);
    const GLuint depths = textureName(state, *buffers.depths);
    const GLuint sorted = textureName(state, *buffers.sorted);
    const auto attachTexture = [&gl](GLenum attachment, GLuint array, int number) {
        gl.glFramebufferTextureLayer(GL_FRAMEBUFFER_EXT, attachment, array, 0, number);
    };
    for (int slot = 0; slot < buffers.slotCount; ++slot) {
        bindOwn(gl, buffers.framebuffers[slot]);
        attachTexture(GL_COLOR_ATTACHMENT0_EXT, colors, slot);
        attachTexture(GL_DEPTH_STENCIL_ATTACHMENT, depths, slot);
    }
    bindOwn(gl, buffers.sortedFramebuffer);
    std::vector<GLenum> targets;
    for (int i = 0; i < sortedTextures(buffers.slotCount); ++i) {
        targets.push_back(GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(i));
        attachTexture(targets.back(), sorted, i);
    }
    gl.glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
    bindOwn(gl, buffers.restFramebuffer);
    attachTexture(GL_DEPTH_STENCIL_ATTACHMENT, depths, 0);
    buffers.colorCount = 0;
}

bool makeCapture(osg::State& state, const AccumulationBuffers& target, CaptureBuffers& buffers,
                 int slotCount)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    if (!buffers.queries[0]) gl.glGenQueries(CaptureBuffers::MAXIMUM_SLOTS, buffers.queries);
    const int w = target.width, h = target.height;
    buffers.width = w;
    buffers.height = h;
    buffers.slotCount = 0;
    buffers.colorFormat = target.colorFormat;
    buffers.colors = makeTargetArray(state, {w, h, slotCount}, target.colorFormat);
    buffers.depths = makeTargetArray(state, {w, h, slotCount}, GL_DEPTH24_STENCIL8_EXT);
    buffers.sorted = makeTargetArray(state, {w, h, sortedTextures(slotCount)}, GL_RGBA32F_ARB);
    if (!buffers.colors || !buffers.depths || !buffers.sorted) {
        buffers.colors = buffers.depths = buffers.sorted = nullptr;
        return false;
    }
    buffers.slotCount = slotCount;
    attachSlots(state, buffers);
    return true;
}

} // namespace

void CaptureBuffers::release(osg::GLExtensions& gl)
{
    deleteFramebuffers(gl, {&sortedFramebuffer, &restFramebuffer});
    for (GLuint& name : framebuffers)
        deleteFramebuffers(gl, {&name});
    if (queries[0]) gl.glDeleteQueries(MAXIMUM_SLOTS, queries);
}

bool ensureCapture(osg::State& state, const AccumulationBuffers& target, CaptureBuffers& buffers,
                   int slotCount)
{
    if (!target.color) return false;
    const bool fits = buffers.colors && buffers.slotCount >= slotCount &&
                      buffers.width == target.width && buffers.height == target.height &&
                      buffers.colorFormat == target.colorFormat;
    if (!fits && !makeCapture(state, target, buffers, slotCount)) return false;
    attachTargetColor(state, buffers.restFramebuffer, target, buffers.colorCount);
    return true;
}

} // namespace render
} // namespace osgVolumizer
