#include "RankBuffers.h"

#include "../../context/TargetBuffers.h"

namespace osgVolumizer {
namespace render {

namespace {

bool makeRanks(osg::State& state, RankBuffers& buffers, int width, int height)
{
    buffers.width = width;
    buffers.height = height;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    // Depth in float, so that what is written back from a texture is what was captured, to the last
    // bit.
    constexpr GLenum FORMAT = GL_DEPTH32F_STENCIL8;
    for (int k = 0; k < RankBuffers::COUNT; ++k) {
        buffers.depths[k] = makeTarget(state, width, height, FORMAT);
        if (!buffers.depths[k]) return false;
        bindDepthOnly(state, buffers.framebuffers[k], *buffers.depths[k], FORMAT);
    }
    for (auto& sorted : buffers.sorted) {
        sorted = makeTarget(state, width, height, GL_RGBA32F_ARB);
        if (!sorted) return false;
    }
    bindOwn(gl, buffers.sortedFramebuffer);
    const GLenum both[2] = {GL_COLOR_ATTACHMENT0_EXT, GL_COLOR_ATTACHMENT1_EXT};
    for (int i = 0; i < 2; ++i)
        attach(gl, both[i], textureName(state, *buffers.sorted[i]));
    gl.glDrawBuffers(2, both);
    buffers.rankDepth = makeTarget(state, width, height, FORMAT);
    if (!buffers.rankDepth) return false;
    buffers.colorCount = 0;
    bindOwn(gl, buffers.rankFramebuffer);
    attachDepth(gl, textureName(state, *buffers.rankDepth), FORMAT);
    if (!buffers.queries[0]) gl.glGenQueries(RankBuffers::COUNT, buffers.queries);
    return true;
}

} // namespace

void RankBuffers::release(osg::GLExtensions& gl)
{
    deleteFramebuffers(gl, {&sortedFramebuffer, &rankFramebuffer});
    for (GLuint& name : framebuffers)
        deleteFramebuffers(gl, {&name});
    if (queries[0]) gl.glDeleteQueries(COUNT, queries);
}

bool ensureRanks(osg::State& state, const AccumulationBuffers& target, RankBuffers& buffers)
{
    if (!target.color) return false;
    const bool fits =
        buffers.rankDepth && buffers.width == target.width && buffers.height == target.height;
    if (!fits && !makeRanks(state, buffers, target.width, target.height)) {
        buffers.rankDepth = nullptr;
        return false;
    }
    attachTargetColor(state, buffers.rankFramebuffer, target, buffers.colorCount);
    return true;
}

} // namespace render
} // namespace osgVolumizer
