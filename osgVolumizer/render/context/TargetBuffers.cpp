#include "TargetBuffers.h"

#include "Allocation.h"
#include "Framebuffer.h"
#include "ProgramInterface.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

// How texels of a format would come from memory; they never do.
void setSource(osg::Texture& texture, GLenum internalFormat)
{
    GLenum format = GL_RGBA, type = GL_FLOAT;
    switch (internalFormat) {
    case GL_DEPTH32F_STENCIL8:
        format = GL_DEPTH_STENCIL_EXT;
        type = GL_FLOAT_32_UNSIGNED_INT_24_8_REV;
        break;
    case GL_DEPTH24_STENCIL8_EXT:
        format = GL_DEPTH_STENCIL_EXT;
        type = GL_UNSIGNED_INT_24_8_EXT;
        break;
    case GL_DEPTH_COMPONENT32F:
        format = GL_DEPTH_COMPONENT;
        break;
    case GL_DEPTH_COMPONENT16:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH_COMPONENT32:
        format = GL_DEPTH_COMPONENT;
        type = GL_UNSIGNED_INT;
        break;
    default:
        break;
    }
    texture.setInternalFormat(static_cast<GLint>(internalFormat));
    texture.setSourceFormat(format);
    texture.setSourceType(type);
    texture.setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture.setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture.setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture.setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture.setResizeNonPowerOfTwoHint(false);
    texture.setDataVariance(osg::Object::STATIC);
}

// Null where the card has no memory for it.
osg::ref_ptr<osg::Texture2D> make(osg::State& state, int width, int height, GLenum internalFormat)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(width, height);
    setSource(*texture, internalFormat);
    return allocateTarget(state, *texture, {width, height, 1}) ? texture : nullptr;
}

osg::ref_ptr<osg::Texture2DArray> makeArray(osg::State& state, const glm::ivec3& size,
                                            GLenum internalFormat)
{
    osg::ref_ptr<osg::Texture2DArray> texture = new osg::Texture2DArray;
    texture->setTextureSize(size.x, size.y, size.z);
    setSource(*texture, internalFormat);
    return allocateTarget(state, *texture, size) ? texture : nullptr;
}

void bind(osg::GLExtensions& gl, GLuint& framebuffer)
{
    if (!framebuffer) gl.glGenFramebuffers(1, &framebuffer);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffer);
}

void attach(osg::GLExtensions& gl, GLenum attachment, GLuint texture)
{
    gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, attachment, GL_TEXTURE_2D, texture, 0);
}

// A framebuffer that has a depth texture only.
void bindDepthOnly(osg::State& state, GLuint& framebuffer, const osg::Texture& depth,
                   GLenum depthFormat)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    bind(gl, framebuffer);
    attachDepth(gl, textureName(state, depth), depthFormat);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
}

// Gives a framebuffer the target's colour, unless that is what is attached already.
void attachTargetColor(osg::State& state, GLuint framebuffer,
                       const AccumulationBuffers& accumulation, unsigned& attachedCount)
{
    if (attachedCount == accumulation.colorCount) return;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffer);
    attach(gl, GL_COLOR_ATTACHMENT0_EXT, textureName(state, *accumulation.color));
    attachedCount = accumulation.colorCount;
}

bool makeLayers(osg::State& state, LayerBuffers& layers, int width, int height)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    // Depth in float, so that what is written back from a texture is what was captured, to the last
    // bit.
    constexpr GLenum FORMAT = GL_DEPTH32F_STENCIL8;
    for (int k = 0; k < LayerBuffers::COUNT; ++k) {
        layers.layers[k] = make(state, width, height, FORMAT);
        if (!layers.layers[k]) return false;
        bindDepthOnly(state, layers.layerFramebuffers[k], *layers.layers[k], FORMAT);
    }
    for (auto& sorted : layers.sorted) {
        sorted = make(state, width, height, GL_RGBA32F_ARB);
        if (!sorted) return false;
    }
    bind(gl, layers.sortedFramebuffer);
    const GLenum both[2] = {GL_COLOR_ATTACHMENT0_EXT, GL_COLOR_ATTACHMENT1_EXT};
    for (int i = 0; i < 2; ++i)
        attach(gl, both[i], textureName(state, *layers.sorted[i]));
    gl.glDrawBuffers(2, both);
    layers.rankDepth = make(state, width, height, FORMAT);
    if (!layers.rankDepth) return false;
    layers.rankColorCount = 0;
    bind(gl, layers.rankFramebuffer);
    attachDepth(gl, textureName(state, *layers.rankDepth), FORMAT);
    if (!layers.queries[0]) gl.glGenQueries(LayerBuffers::COUNT, layers.queries);
    return true;
}

// Gives the framebuffers of slots their layers of the arrays.
void attachSlots(osg::State& state, CaptureBuffers& buffers)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const GLuint colors = textureName(state, *buffers.colors);
    const GLuint depths = textureName(state, *buffers.depths);
    const GLuint sorted = textureName(state, *buffers.sorted);
    const auto attachLayer = [&gl](GLenum attachment, GLuint array, int layer) {
        gl.glFramebufferTextureLayer(GL_FRAMEBUFFER_EXT, attachment, array, 0, layer);
    };
    for (int slot = 0; slot < buffers.slotCount; ++slot) {
        bind(gl, buffers.framebuffers[slot]);
        attachLayer(GL_COLOR_ATTACHMENT0_EXT, colors, slot);
        attachLayer(GL_DEPTH_STENCIL_ATTACHMENT, depths, slot);
    }
    bind(gl, buffers.sortedFramebuffer);
    std::vector<GLenum> targets;
    for (int layer = 0; layer < sortedLayers(buffers.slotCount); ++layer) {
        targets.push_back(GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(layer));
        attachLayer(targets.back(), sorted, layer);
    }
    gl.glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
    bind(gl, buffers.restFramebuffer);
    attachLayer(GL_DEPTH_STENCIL_ATTACHMENT, depths, 0);
    buffers.restColorCount = 0;
}

bool makeCapture(osg::State& state, const AccumulationBuffers& accumulation,
                 CaptureBuffers& buffers, int slotCount)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    if (!buffers.queries[0]) gl.glGenQueries(CaptureBuffers::MAXIMUM_SLOTS, buffers.queries);
    const int w = accumulation.width, h = accumulation.height;
    buffers.width = w;
    buffers.height = h;
    buffers.slotCount = 0;
    buffers.colorFormat = accumulation.colorFormat;
    buffers.colors = makeArray(state, {w, h, slotCount}, accumulation.colorFormat);
    buffers.depths = makeArray(state, {w, h, slotCount}, GL_DEPTH24_STENCIL8_EXT);
    buffers.sorted = makeArray(state, {w, h, sortedLayers(slotCount)}, GL_RGBA32F_ARB);
    if (!buffers.colors || !buffers.depths || !buffers.sorted) {
        buffers.colors = buffers.depths = buffers.sorted = nullptr;
        return false;
    }
    buffers.slotCount = slotCount;
    attachSlots(state, buffers);
    return true;
}

} // namespace

GLuint textureName(const osg::State& state, const osg::Texture& texture)
{
    return texture.getTextureObject(state.getContextID())->id();
}

void attachDepth(osg::GLExtensions& gl, GLuint texture, GLenum depthFormat)
{
    attach(gl, GL_DEPTH_STENCIL_ATTACHMENT, 0);
    attach(gl,
           hasStencil(depthFormat) ? GLenum(GL_DEPTH_STENCIL_ATTACHMENT)
                                   : GLenum(GL_DEPTH_ATTACHMENT_EXT),
           texture);
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
    buffers.color = buffers.layerDepth = buffers.layers.rankDepth = nullptr;
    buffers.opaqueDepth = make(state, buffers.width, buffers.height, depthFormat);
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
    buffers.depth = make(state, buffers.width, buffers.height, buffers.depthFormat);
    if (!buffers.depth) return false;
    buffers.askedFormat = colorFormats.front();
    for (GLenum format : colorFormats) {
        buffers.colorFormat = format;
        buffers.color = make(state, buffers.width, buffers.height, format);
        if (!buffers.color) continue;
        ++buffers.colorCount;
        bind(gl, buffers.framebuffer);
        attach(gl, GL_COLOR_ATTACHMENT0_EXT, textureName(state, *buffers.color));
        attachDepth(gl, textureName(state, *buffers.depth), buffers.depthFormat);
        if (gl.glCheckFramebufferStatus(GL_FRAMEBUFFER_EXT) == GL_FRAMEBUFFER_COMPLETE_EXT)
            return true;
        buffers.color = nullptr;
    }
    return false;
}

bool ensureLayerDepth(osg::State& state, AccumulationBuffers& buffers)
{
    if (buffers.layerDepth) return true;
    buffers.layerDepth = make(state, buffers.width, buffers.height, buffers.depthFormat);
    if (!buffers.layerDepth) return false;
    bindDepthOnly(state, buffers.layerFramebuffer, *buffers.layerDepth, buffers.depthFormat);
    return true;
}

bool ensureLayers(osg::State& state, AccumulationBuffers& buffers)
{
    LayerBuffers& layers = buffers.layers;
    if (!buffers.color) return false;
    if (!layers.rankDepth && !makeLayers(state, layers, buffers.width, buffers.height)) {
        layers.rankDepth = nullptr;
        return false;
    }
    attachTargetColor(state, layers.rankFramebuffer, buffers, layers.rankColorCount);
    return true;
}

bool ensureCapture(osg::State& state, const AccumulationBuffers& accumulation,
                   CaptureBuffers& buffers, int slotCount)
{
    if (!accumulation.color) return false;
    const bool fits =
        buffers.colors && buffers.slotCount >= slotCount && buffers.width == accumulation.width &&
        buffers.height == accumulation.height && buffers.colorFormat == accumulation.colorFormat;
    if (!fits && !makeCapture(state, accumulation, buffers, slotCount)) return false;
    attachTargetColor(state, buffers.restFramebuffer, accumulation, buffers.restColorCount);
    return true;
}

bool ensureRays(osg::State& state, RayBuffers& buffers, int width, int height)
{
    if (buffers.color && buffers.width >= width && buffers.height >= height) return true;
    buffers.width = std::max(width, buffers.width);
    buffers.height = std::max(height, buffers.height);
    buffers.color = make(state, buffers.width, buffers.height, GL_RGBA32F_ARB);
    if (!buffers.color) {
        buffers.width = buffers.height = 0;
        return false;
    }
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    bind(gl, buffers.framebuffer);
    attach(gl, GL_COLOR_ATTACHMENT0_EXT, textureName(state, *buffers.color));
    return true;
}

} // namespace render
} // namespace osgVolumizer
