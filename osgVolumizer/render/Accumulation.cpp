#include "Accumulation.h"

#include "ReportOnce.h"
#include "ScissorScope.h"
#include "ScreenPass.h"
#include "SharedStateSets.h"
#include "Statistics.h"
#include "VolumeProgram.h"

#include <osg/Depth>
#include <osgUtil/StateGraph>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

osg::ref_ptr<osg::Texture2D> makeTarget(int width, int height, GLenum internalFormat, GLenum format,
                                        GLenum type)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(width, height);
    texture->setInternalFormat(static_cast<GLint>(internalFormat));
    texture->setSourceFormat(format);
    texture->setSourceType(type);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
}

osg::ref_ptr<osg::Texture2D> makeDepth(int width, int height, GLenum format)
{
    if (format == GL_DEPTH32F_STENCIL8)
        return makeTarget(width, height, format, GL_DEPTH_STENCIL_EXT,
                          GL_FLOAT_32_UNSIGNED_INT_24_8_REV);
    if (format == GL_DEPTH24_STENCIL8_EXT)
        return makeTarget(width, height, format, GL_DEPTH_STENCIL_EXT, GL_UNSIGNED_INT_24_8_EXT);
    return makeTarget(width, height, format, GL_DEPTH_COMPONENT,
                      format == GL_DEPTH_COMPONENT32F ? GL_FLOAT : GL_UNSIGNED_INT);
}

// The format of the target. Without float targets fixed point is the next best, which holds all
// that a framebuffer shows.
GLenum colorFormatOf(int bits, const ContextLimits& limits)
{
    if (bits <= 8) return GL_RGBA8;
    if (limits.floatTargets) return bits <= 16 ? GL_RGBA16F_ARB : GL_RGBA32F_ARB;
    reportOnce({ErrorCode::NOT_SUPPORTED, "the context has no float targets; volumes are "
                                          "accumulated in fixed point, 16 bits a channel"});
    return GL_RGBA16;
}

// Binds a texture for raw GL calls, and makes OSG bind its own again before the next leaf.
void bindForCopy(osg::State& state, osg::Texture2D& texture)
{
    state.setActiveTextureUnit(UNIT_OPAQUE_DEPTH);
    texture.apply(state);
    state.haveAppliedTextureAttribute(UNIT_OPAQUE_DEPTH, osg::StateAttribute::TEXTURE);
}

GLuint textureName(osg::State& state, osg::Texture2D& texture)
{
    bindForCopy(state, texture);
    return texture.getTextureObject(state.getContextID())->id();
}

// Bits of an attachment of the framebuffer that is drawn to; `window` names the same part of a
// window.
GLint attachmentBits(const ContextResources& resources, GLint framebuffer, GLenum attachment,
                     GLenum window, GLenum parameter)
{
    GLint bits = 0;
    resources.glGetFramebufferAttachmentParameteriv(
        GL_DRAW_FRAMEBUFFER_EXT, framebuffer ? attachment : window, parameter, &bits);
    return bits;
}

// As precise as the framebuffer's own depth, so that equal depths stay equal; of several samples
// one is got only by a blit between like formats.
GLenum depthFormatOfFramebuffer(const ContextResources& resources, GLint framebuffer, bool samples)
{
    const GLint bits = attachmentBits(resources, framebuffer, GL_DEPTH_ATTACHMENT_EXT, GL_DEPTH,
                                      GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE);
    if (samples && attachmentBits(resources, framebuffer, GL_STENCIL_ATTACHMENT_EXT, GL_STENCIL,
                                  GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE) > 0)
        return bits > 24 ? GL_DEPTH32F_STENCIL8 : GL_DEPTH24_STENCIL8_EXT;
    return bits > 24 ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24;
}

void ensureDepth(AccumulationBuffers& buffers, int width, int height, GLenum depthFormat)
{
    if (buffers.opaqueDepth && buffers.width >= width && buffers.height >= height &&
        buffers.depthFormat == depthFormat)
        return;
    buffers.width = std::max(width, buffers.width);
    buffers.height = std::max(height, buffers.height);
    buffers.depthFormat = depthFormat;
    buffers.opaqueDepth = makeDepth(buffers.width, buffers.height, depthFormat);
    buffers.color = nullptr;
    buffers.layerDepth = nullptr;
    buffers.layers.rankDepth = nullptr;
}

void ensureTarget(osg::State& state, AccumulationBuffers& buffers, GLenum colorFormat)
{
    if (buffers.color && buffers.colorFormat == colorFormat) return;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    buffers.colorFormat = colorFormat;
    buffers.color = makeTarget(buffers.width, buffers.height, colorFormat, GL_RGBA, GL_FLOAT);
    buffers.depth = makeDepth(buffers.width, buffers.height, buffers.depthFormat);
    const GLuint color = textureName(state, *buffers.color);
    const GLuint depth = textureName(state, *buffers.depth);
    if (!buffers.framebuffer) gl.glGenFramebuffers(1, &buffers.framebuffer);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, buffers.framebuffer);
    gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, GL_COLOR_ATTACHMENT0_EXT, GL_TEXTURE_2D, color,
                              0);
    gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, GL_DEPTH_ATTACHMENT_EXT, GL_TEXTURE_2D, depth, 0);
}

// Of the leaf that ends accumulation: writes depth.
osg::ref_ptr<osg::StateSet> depthStateSet()
{
    return sharedStateSet(SharedState::DEPTH, []() {
        osg::ref_ptr<osg::StateSet> set = screenState("depth.frag.glsl", true);
        set->addUniform(new osg::Uniform("opaqueDepth", int(UNIT_OPAQUE_DEPTH)));
        set->addUniform(new osg::Uniform("targetDepth", int(UNIT_LAYER_DEPTH)));
        return set;
    });
}

// Clearing the layer buffer needs depth writes.
osg::ref_ptr<osg::StateSet> accumulationStateSet()
{
    return sharedStateSet(SharedState::ACCUMULATION, []() {
        osg::ref_ptr<osg::StateSet> s = new osg::StateSet;
        s->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, true),
                                osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE |
                                    osg::StateAttribute::PROTECTED);
        return s;
    });
}

// Depth in float, so that what is written back from a texture is what was captured, to the last
// bit.
osg::ref_ptr<osg::Texture2D> makeDepthStencil(int width, int height)
{
    return makeTarget(width, height, GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL_EXT,
                      GL_FLOAT_32_UNSIGNED_INT_24_8_REV);
}

void makeLayerTextures(osg::State& state, AccumulationBuffers& buffers)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    LayerBuffers& layers = buffers.layers;
    const int w = buffers.width, h = buffers.height;
    const auto attach = [&](GLenum attachment, osg::Texture2D& texture) {
        gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, attachment, GL_TEXTURE_2D,
                                  textureName(state, texture), 0);
    };
    if (!layers.queries[0]) {
        gl.glGenQueries(LayerBuffers::COUNT, layers.queries);
        gl.glGenFramebuffers(LayerBuffers::COUNT, layers.layerFramebuffers);
        gl.glGenFramebuffers(1, &layers.sortedFramebuffer);
        gl.glGenFramebuffers(1, &layers.rankFramebuffer);
    }
    for (int k = 0; k < LayerBuffers::COUNT; ++k) {
        layers.layers[k] = makeDepthStencil(w, h);
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, layers.layerFramebuffers[k]);
        attach(GL_DEPTH_STENCIL_ATTACHMENT, *layers.layers[k]);
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    }
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, layers.sortedFramebuffer);
    for (int i = 0; i < 2; ++i) {
        layers.sorted[i] = makeTarget(w, h, GL_RGBA32F_ARB, GL_RGBA, GL_FLOAT);
        attach(GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(i), *layers.sorted[i]);
    }
    const GLenum both[2] = {GL_COLOR_ATTACHMENT0_EXT, GL_COLOR_ATTACHMENT1_EXT};
    gl.glDrawBuffers(2, both);
    layers.rankDepth = makeDepthStencil(w, h);
    layers.rankColor = nullptr;
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, layers.rankFramebuffer);
    attach(GL_DEPTH_STENCIL_ATTACHMENT, *layers.rankDepth);
}

osg::ref_ptr<osg::Texture2DArray> makeArray(int width, int height, int layers,
                                            GLenum internalFormat, GLenum format, GLenum type)
{
    osg::ref_ptr<osg::Texture2DArray> texture = new osg::Texture2DArray;
    texture->setTextureSize(width, height, layers);
    texture->setInternalFormat(static_cast<GLint>(internalFormat));
    texture->setSourceFormat(format);
    texture->setSourceType(type);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
}

GLuint arrayName(osg::State& state, osg::Texture2DArray& texture)
{
    state.setActiveTextureUnit(UNIT_OPAQUE_DEPTH);
    texture.apply(state);
    state.haveAppliedTextureAttribute(UNIT_OPAQUE_DEPTH, osg::StateAttribute::TEXTURE);
    return texture.getTextureObject(state.getContextID())->id();
}

void makeCaptureTextures(osg::State& state, const AccumulationBuffers& accumulation,
                         CaptureBuffers& buffers, int slotCount)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    if (!buffers.queries[0]) {
        gl.glGenQueries(CaptureBuffers::MAXIMUM_SLOTS, buffers.queries);
        gl.glGenFramebuffers(CaptureBuffers::MAXIMUM_SLOTS, buffers.framebuffers);
        gl.glGenFramebuffers(1, &buffers.sortedFramebuffer);
        gl.glGenFramebuffers(1, &buffers.restFramebuffer);
    }
    const int w = accumulation.width, h = accumulation.height;
    buffers.width = w;
    buffers.height = h;
    buffers.slotCount = slotCount;
    buffers.colorFormat = accumulation.colorFormat;
    buffers.colors = makeArray(w, h, slotCount, accumulation.colorFormat, GL_RGBA, GL_FLOAT);
    buffers.depths = makeArray(w, h, slotCount, GL_DEPTH24_STENCIL8_EXT, GL_DEPTH_STENCIL_EXT,
                               GL_UNSIGNED_INT_24_8_EXT);
    buffers.sorted = makeArray(w, h, sortedLayers(slotCount), GL_RGBA32F_ARB, GL_RGBA, GL_FLOAT);
    const GLuint colors = arrayName(state, *buffers.colors);
    const GLuint depths = arrayName(state, *buffers.depths);
    const GLuint sorted = arrayName(state, *buffers.sorted);
    for (int slot = 0; slot < slotCount; ++slot) {
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, buffers.framebuffers[slot]);
        gl.glFramebufferTextureLayer(GL_FRAMEBUFFER_EXT, GL_COLOR_ATTACHMENT0_EXT, colors, 0, slot);
        gl.glFramebufferTextureLayer(GL_FRAMEBUFFER_EXT, GL_DEPTH_STENCIL_ATTACHMENT, depths, 0,
                                     slot);
    }
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, buffers.sortedFramebuffer);
    std::vector<GLenum> targets;
    for (int layer = 0; layer < sortedLayers(slotCount); ++layer) {
        targets.push_back(GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(layer));
        gl.glFramebufferTextureLayer(GL_FRAMEBUFFER_EXT, targets.back(), sorted, 0, layer);
    }
    gl.glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, buffers.restFramebuffer);
    gl.glFramebufferTextureLayer(GL_FRAMEBUFFER_EXT, GL_DEPTH_STENCIL_ATTACHMENT, depths, 0, 0);
    buffers.restColor = nullptr;
}

// Gives a framebuffer the target's colour, unless that is what is attached already.
void attachColor(osg::State& state, GLuint framebuffer, osg::Texture2D& color,
                 const osg::Texture2D*& attached)
{
    if (attached == &color) return;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const GLuint name = textureName(state, color);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffer);
    gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, GL_COLOR_ATTACHMENT0_EXT, GL_TEXTURE_2D, name, 0);
    attached = &color;
}

} // namespace

CaptureBuffers& Accumulation::captureBuffers(osg::State& state, int slotCount)
{
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    const AccumulationBuffers& accumulation = resources->accumulation;
    CaptureBuffers& buffers = resources->capture;
    if (buffers.slotCount < slotCount || buffers.width != accumulation.width ||
        buffers.height != accumulation.height || buffers.colorFormat != accumulation.colorFormat)
        makeCaptureTextures(state, accumulation, buffers, slotCount);
    attachColor(state, buffers.restFramebuffer, *accumulation.color, buffers.restColor);
    return buffers;
}

LayerBuffers& Accumulation::layerBuffers(osg::State& state)
{
    AccumulationBuffers& buffers = contextResources(state)->accumulation;
    LayerBuffers& layers = buffers.layers;
    if (!layers.rankDepth) makeLayerTextures(state, buffers);
    attachColor(state, layers.rankFramebuffer, *buffers.color, layers.rankColor);
    return layers;
}

bool Accumulation::needsTarget(const ContextResources& resources) const
{
    return _targetRequired || _sampleBuffers > 0 ||
           attachmentBits(resources, _drawFramebuffer, GL_COLOR_ATTACHMENT0_EXT, GL_BACK_LEFT,
                          GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE) < _settings.bits;
}

void Accumulation::begin(osg::RenderInfo& renderInfo)
{
    osg::State& state = *renderInfo.getState();
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    AccumulationBuffers& buffers = resources->accumulation;
    const glm::ivec4& viewport = _settings.viewport;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING_EXT, &_drawFramebuffer);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING_EXT, &_readFramebuffer);
    glGetIntegerv(GL_SAMPLE_BUFFERS, &_sampleBuffers);

    ensureDepth(buffers, viewport[0] + viewport[2], viewport[1] + viewport[3],
                depthFormatOfFramebuffer(*resources, _drawFramebuffer, _sampleBuffers > 0));
    const auto countCopied = [&](const char* name, int copies) {
        count(renderInfo.getCurrentCamera(), state.getFrameStamp(), name,
              double(copies) * _area[2] * _area[3]);
    };
    buffers.hasOpaqueDepth = !_depthCleared;
    if (!_depthCleared) {
        copyOpaqueDepth(state, buffers);
        countCopied("osgVolumizer depths copied", 1);
    }
    if (needsTarget(*resources)) {
        countCopied("osgVolumizer colors copied", 2); // and back
        ensureTarget(state, buffers, colorFormatOf(_settings.bits, resources->limits));
        copyToTarget(state, buffers);
        _redirected = true;
    }
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, buffers.opaqueDepth.get());
}

void Accumulation::blitFrom(osg::GLExtensions& gl, GLuint from, GLuint to, GLbitfield what) const
{
    const int x0 = _area[0], y0 = _area[1], x1 = x0 + _area[2], y1 = y0 + _area[3];
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, from);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, to);
    gl.glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, what, GL_NEAREST);
}

void Accumulation::copyTo(osg::State& state, osg::Texture2D& depth, GLuint from) const
{
    state.get<osg::GLExtensions>()->glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, from);
    bindForCopy(state, depth);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, _area[0], _area[1], _area[0], _area[1], _area[2],
                        _area[3]);
}

void Accumulation::copyOpaqueDepth(osg::State& state, AccumulationBuffers& buffers)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const GLuint source = static_cast<GLuint>(_drawFramebuffer);
    if (_sampleBuffers == 0) {
        copyTo(state, *buffers.opaqueDepth, source);
        return;
    }
    const GLuint depth = textureName(state, *buffers.opaqueDepth);
    if (!buffers.resolveFramebuffer) gl.glGenFramebuffers(1, &buffers.resolveFramebuffer);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, buffers.resolveFramebuffer);
    gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, GL_DEPTH_ATTACHMENT_EXT, GL_TEXTURE_2D, depth, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    blitFrom(gl, source, buffers.resolveFramebuffer, GL_DEPTH_BUFFER_BIT);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, source);
}

void Accumulation::copyToTarget(osg::State& state, AccumulationBuffers& buffers)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const GLuint source = static_cast<GLuint>(_drawFramebuffer);
    const bool blitsDepth = _sampleBuffers > 0 && !_depthCleared;
    if (!_depthCleared && !blitsDepth) copyTo(state, *buffers.depth, source);
    blitFrom(gl, source, buffers.framebuffer,
             GL_COLOR_BUFFER_BIT | (blitsDepth ? GL_DEPTH_BUFFER_BIT : 0u));
    if (_depthCleared) clearArea(_area, GL_DEPTH_BUFFER_BIT);
}

void Accumulation::end(osg::RenderInfo& renderInfo)
{
    osg::State& state = *renderInfo.getState();
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    if (_redirected) writeBack(state, *contextResources(state));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, static_cast<GLuint>(_drawFramebuffer));
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, static_cast<GLuint>(_readFramebuffer));
    state.haveAppliedTextureAttribute(UNIT_OPAQUE_DEPTH, osg::StateAttribute::TEXTURE);
}

void Accumulation::beginLayer(osg::RenderInfo& renderInfo, const glm::ivec4& area)
{
    osg::State& state = *renderInfo.getState();
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    AccumulationBuffers& buffers = resources->accumulation;
    if (!buffers.layerDepth) {
        buffers.layerDepth = makeDepth(buffers.width, buffers.height, buffers.depthFormat);
        const GLuint depth = textureName(state, *buffers.layerDepth);
        if (!buffers.layerFramebuffer) gl.glGenFramebuffers(1, &buffers.layerFramebuffer);
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, buffers.layerFramebuffer);
        gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, GL_DEPTH_ATTACHMENT_EXT, GL_TEXTURE_2D, depth,
                                  0);
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    }
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, buffers.layerFramebuffer);
    const ScissorScope scissor;
    scissor.set(area);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void Accumulation::endLayer(osg::RenderInfo& renderInfo)
{
    osg::State& state = *renderInfo.getState();
    const GLuint target = _redirected ? contextResources(state)->accumulation.framebuffer
                                      : static_cast<GLuint>(_drawFramebuffer);
    state.get<osg::GLExtensions>()->glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, target);
}

void Accumulation::writeBack(osg::State& state, ContextResources& resources)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const AccumulationBuffers& buffers = resources.accumulation;
    blitFrom(gl, buffers.framebuffer, static_cast<GLuint>(_drawFramebuffer), GL_COLOR_BUFFER_BIT);
    if (!_depthKept) return;
    // Not a blit, which would need the framebuffer's very format.
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, buffers.opaqueDepth);
    state.applyTextureAttribute(UNIT_LAYER_DEPTH, buffers.depth);
    drawScreen(state, resources, _area);
    state.haveAppliedTextureAttribute(UNIT_LAYER_DEPTH, osg::StateAttribute::TEXTURE);
}

AccumulationLeaf::AccumulationLeaf(Accumulation* accumulation, Step step, const glm::ivec4& area)
    : _accumulation(accumulation), _step(step), _area(area)
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
    setDataVariance(osg::Object::STATIC);
}

void AccumulationLeaf::drawImplementation(osg::RenderInfo& renderInfo) const
{
    if (!_accumulation) return;
    switch (_step) {
    case BEGIN:
        _accumulation->begin(renderInfo);
        break;
    case END:
        _accumulation->end(renderInfo);
        break;
    case BEGIN_LAYER:
        _accumulation->beginLayer(renderInfo, _area);
        break;
    case END_LAYER:
        _accumulation->endLayer(renderInfo);
        break;
    }
}

osgUtil::RenderLeaf* accumulationLeaf(Accumulation& accumulation, AccumulationLeaf::Step step,
                                      const osgUtil::RenderLeaf& beside, const glm::ivec4& area)
{
    osg::ref_ptr<osgUtil::RenderLeaf> leaf = new osgUtil::RenderLeaf(
        new AccumulationLeaf(&accumulation, step, area), beside._projection, beside._modelview);
    const bool writesDepth = step == AccumulationLeaf::END && accumulation.isDepthKept();
    const osg::ref_ptr<osg::StateSet> set = writesDepth ? depthStateSet() : accumulationStateSet();
    beside._parent->find_or_insert(set)->addLeaf(leaf);
    return leaf.get();
}

} // namespace render
} // namespace osgVolumizer
