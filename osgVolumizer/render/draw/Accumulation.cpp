#include "Accumulation.h"

#include "../context/March.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../context/ScissorScope.h"
#include "../context/ScreenPass.h"
#include "../context/Statistics.h"
#include "AccumulationBuffers.h"
#include "VolumeProgram.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

// Windows may begin left of or below the screen, or the framebuffer: nothing is drawn there.
glm::ivec4 visiblePart(const glm::ivec4& r)
{
    const int x = std::max(r[0], 0), y = std::max(r[1], 0);
    return {x, y, std::max(r[0] + r[2] - x, 0), std::max(r[1] + r[3] - y, 0)};
}

// Formats of the target, best first. Without float targets fixed point is the next best, which
// holds all that a framebuffer shows.
std::vector<GLenum> colorFormats(int bits, const ContextLimits& limits)
{
    if (bits <= 8) return {GL_RGBA8};
    if (!limits.floatTargets) {
        reportOnce({ErrorCode::NOT_SUPPORTED, "the context has no float targets; volumes are "
                                              "accumulated in fixed point, 16 bits a channel"});
        return {GL_RGBA16, GL_RGBA8};
    }
    if (bits <= 16) return {GL_RGBA16F_ARB, GL_RGBA8};
    return {GL_RGBA32F_ARB, GL_RGBA16F_ARB, GL_RGBA8};
}

// Binds a texture for raw GL calls, and makes OSG bind its own again before the next leaf.
void bindForCopy(osg::State& state, osg::Texture2D& texture)
{
    state.setActiveTextureUnit(UNIT_OPAQUE_DEPTH);
    texture.apply(state);
    state.haveAppliedTextureAttribute(UNIT_OPAQUE_DEPTH, osg::StateAttribute::TEXTURE);
}

void reportMemory(const std::string& what)
{
    reportOnce({ErrorCode::NOT_SUPPORTED, "the card has no memory for " + what});
}

// The target, in the best format that there is memory for.
bool makeTargets(osg::State& state, int bits, ContextResources& resources)
{
    AccumulationBuffers& buffers = resources.part<AccumulationBuffers>();
    const std::vector<GLenum> formats = colorFormats(bits, resources.limits);
    if (!ensureTarget(state, buffers, formats)) {
        reportMemory("a target; volumes are drawn to the framebuffer, which may round more");
        return false;
    }
    if (buffers.colorFormat != formats.front())
        reportMemory("a target of as many bits as asked for; volumes are rounded to fewer");
    return true;
}

// What decides which formats can be blitted to.
std::uint64_t blitKey(const Framebuffer& f, GLbitfield what)
{
    std::uint64_t key = f.draw == 0;
    key = key << 1 | std::uint64_t(f.multisampled);
    key = key << 1 | std::uint64_t(f.floatDepth);
    key = key << 8 | std::uint64_t(f.depthBits & 0xff);
    key = key << 8 | std::uint64_t(f.stencilBits & 0xff);
    return key << 32 | what;
}

} // namespace

Accumulation::Accumulation(const AccumulationSettings& settings)
    : _settings(settings), _area(visiblePart(settings.viewport))
{
}

void Accumulation::restrictTo(const glm::ivec4& area)
{
    _area = visiblePart(area);
}

bool Accumulation::needsTarget(osg::State& state, ContextResources& resources) const
{
    if (_targetRequired || _framebuffer.multisampled || _framebuffer.colorBits < _settings.bits)
        return true;
    return _settings.marched && _settings.bits > 8 && marchOf(state, resources) == March::COMPUTE;
}

// As precise as the framebuffer's own depth, so that equal depths stay equal. Of several samples
// one is got only by a blit between like formats, and so are stencil values.
GLenum Accumulation::depthFormat(osg::State& state, AccumulationBuffers& buffers) const
{
    const bool precise = _framebuffer.floatDepth || _framebuffer.depthBits > 24;
    const GLenum usual = precise ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24;
    if (!_depthBlitted) return usual;
    const GLbitfield depth = _framebuffer.depthBits > 0 ? GL_DEPTH_BUFFER_BIT : 0u;
    const GLbitfield what = depth | (_stencilUsed ? GL_STENCIL_BUFFER_BIT : 0u);
    const auto known = buffers.blitFormats.emplace(blitKey(_framebuffer, what), GLenum(GL_NONE));
    if (known.second)
        known.first->second = findBlitFormat(*state.get<osg::GLExtensions>(),
                                             *contextResources(state), _framebuffer, what);
    return known.first->second;
}

void Accumulation::begin(osg::RenderInfo& renderInfo)
{
    osg::State& state = *renderInfo.getState();
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    AccumulationBuffers& buffers = resources->part<AccumulationBuffers>();
    _framebuffer = queryFramebuffer(*resources);
    buffers.drawBuffers = _framebuffer.drawBuffers;
    _depthCleared = _depthCleared || _framebuffer.depthBits == 0;
    _stencilUsed = _stencilUsed && _framebuffer.stencilBits > 0;
    _depthBlitted = _stencilUsed || (_framebuffer.multisampled && !_depthCleared);
    GLenum format = depthFormat(state, buffers);
    if (format == GL_NONE) {
        reportOnce({ErrorCode::NOT_SUPPORTED,
                    "the depth and stencil buffers of the framebuffer cannot be copied; volumes "
                    "are drawn without regard to what is in them"});
        _depthCleared = true;
        _stencilUsed = _depthBlitted = false;
        format = depthFormat(state, buffers);
    }
    const auto countCopied = [&](const char* name, int copies) {
        count(renderInfo.getCurrentCamera(), state.getFrameStamp(), name,
              double(copies) * _area[2] * _area[3]);
    };
    const bool visible = _area[2] > 0 && _area[3] > 0;
    const bool hasDepth = visible && ensureOpaqueDepth(state, buffers, _area[0] + _area[2],
                                                       _area[1] + _area[3], format);
    if (visible && !hasDepth)
        reportMemory("a copy of the depth buffer; volumes do not end at opaque geometry in them");
    buffers.hasOpaqueDepth = hasDepth && !_depthCleared;
    if (hasDepth) copyOpaqueDepth(state, buffers);
    if (buffers.hasOpaqueDepth) countCopied("osgVolumizer depths copied", 1);
    if (hasDepth && needsTarget(state, *resources) &&
        makeTargets(state, _settings.bits, *resources)) {
        countCopied("osgVolumizer colors copied", 2); // and back
        _redirected = true;
        copyToTarget(state, buffers);
        shareOtherBuffers(state, *resources);
    }
    bindTarget(state);
    if (buffers.opaqueDepth)
        state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, buffers.opaqueDepth.get());
}

void Accumulation::bindTarget(osg::State& state) const
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const GLuint target = contextResources(state)->part<AccumulationBuffers>().framebuffer;
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, _redirected ? target : _framebuffer.draw);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, _redirected ? target : _framebuffer.read);
}

void Accumulation::blit(osg::GLExtensions& gl, GLuint from, GLuint to, GLbitfield what) const
{
    const int x0 = _area[0], y0 = _area[1], x1 = x0 + _area[2], y1 = y0 + _area[3];
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, from);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, to);
    gl.glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, what, GL_NEAREST);
}

void Accumulation::copyOpaqueDepth(osg::State& state, AccumulationBuffers& buffers) const
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    if (_depthCleared) {
        if (_framebuffer.depthBits > 0) return;
        gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, buffers.opaqueFramebuffer);
        clearArea(_area, GL_DEPTH_BUFFER_BIT);
    } else if (_depthBlitted) {
        blit(gl, _framebuffer.draw, buffers.opaqueFramebuffer, GL_DEPTH_BUFFER_BIT);
    } else {
        gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, _framebuffer.draw);
        bindForCopy(state, *buffers.opaqueDepth);
        glCopyTexSubImage2D(GL_TEXTURE_2D, 0, _area[0], _area[1], _area[0], _area[1], _area[2],
                            _area[3]);
    }
}

void Accumulation::copyToTarget(osg::State& state, AccumulationBuffers& buffers) const
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    GLbitfield what = _stencilUsed ? GL_STENCIL_BUFFER_BIT : 0u;
    if (!_depthCleared) {
        // From our own copy: a blit between like formats, whatever the framebuffer has.
        blit(gl, buffers.opaqueFramebuffer, buffers.framebuffer, GL_DEPTH_BUFFER_BIT);
    }
    if (_framebuffer.hasColor()) what |= GL_COLOR_BUFFER_BIT;
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, _framebuffer.draw);
    if (_framebuffer.hasColor()) {
        const ReadBufferScope read(_framebuffer.drawBuffers.front());
        blit(gl, _framebuffer.draw, buffers.framebuffer, what);
    } else if (what) {
        blit(gl, _framebuffer.draw, buffers.framebuffer, what);
    }
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, buffers.framebuffer);
    if (_depthCleared) clearArea(_area, GL_DEPTH_BUFFER_BIT);
}

// Outputs of shaders beyond the first go where they would go without volumes: textures and render
// buffers of the framebuffer belong to the target too. Not those of several samples, which cannot
// be drawn to together with one of one sample.
void Accumulation::shareOtherBuffers(osg::State& state, ContextResources& resources) const
{
    AccumulationBuffers& buffers = resources.part<AccumulationBuffers>();
    buffers.drawBuffers = {GL_COLOR_ATTACHMENT0_EXT};
    if (_framebuffer.drawBuffers.size() > 1 && _framebuffer.draw && !_framebuffer.multisampled)
        buffers.drawBuffers = shareAttachments(*state.get<osg::GLExtensions>(), resources,
                                               _framebuffer, buffers.framebuffer);
}

void Accumulation::end(osg::RenderInfo& renderInfo)
{
    osg::State& state = *renderInfo.getState();
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    if (_redirected) writeBack(state, *contextResources(state));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, _framebuffer.draw);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, _framebuffer.read);
    state.haveAppliedTextureAttribute(UNIT_OPAQUE_DEPTH, osg::StateAttribute::TEXTURE);
}

void Accumulation::beginSplit(osg::RenderInfo& renderInfo, const glm::ivec4& area)
{
    osg::State& state = *renderInfo.getState();
    AccumulationBuffers& buffers = contextResources(state)->part<AccumulationBuffers>();
    if (!ensureSplitDepth(state, buffers)) {
        // Nothing splits the segment then.
        glEnable(GL_RASTERIZER_DISCARD);
        return;
    }
    bindFramebuffer(state, buffers.splitFramebuffer);
    clearArea(area, GL_DEPTH_BUFFER_BIT);
}

void Accumulation::endSplit(osg::RenderInfo& renderInfo)
{
    osg::State& state = *renderInfo.getState();
    if (!contextResources(state)->part<AccumulationBuffers>().splitDepth)
        glDisable(GL_RASTERIZER_DISCARD);
    bindTarget(state);
}

void Accumulation::writeBack(osg::State& state, ContextResources& resources) const
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    AccumulationBuffers& buffers = resources.part<AccumulationBuffers>();
    if (buffers.drawBuffers.size() > 1)
        unshareAttachments(gl, buffers.framebuffer, buffers.drawBuffers.size());
    buffers.drawBuffers = _framebuffer.drawBuffers;
    const GLbitfield stencil = _stencilUsed ? GL_STENCIL_BUFFER_BIT : 0u;
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, _framebuffer.draw);
    {
        const FirstDrawBufferScope first(gl, _framebuffer.drawBuffers);
        const GLbitfield what = stencil | (_framebuffer.hasColor() ? GL_COLOR_BUFFER_BIT : 0u);
        if (what) blit(gl, buffers.framebuffer, _framebuffer.draw, what);
    }
    if (!_depthKept || _framebuffer.depthBits == 0) return;
    // Not a blit, which would need the framebuffer's very format.
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, buffers.opaqueDepth);
    state.applyTextureAttribute(UNIT_SPLIT_DEPTH, buffers.depth);
    drawScreen(state, resources, _area);
    state.haveAppliedTextureAttribute(UNIT_SPLIT_DEPTH, osg::StateAttribute::TEXTURE);
}

} // namespace render
} // namespace osgVolumizer
