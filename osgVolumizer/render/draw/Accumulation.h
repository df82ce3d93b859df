#pragma once

#include "../context/ContextResources.h"
#include "../context/Framebuffer.h"
#include "AccumulationBuffers.h"

#include <osg/Drawable>
#include <osgUtil/RenderLeaf>

#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace render {

/// What the leaves between begin and end draw into.
struct AccumulationSettings
{
    /// Bits per colour channel, 8, 16 or 32, of the target; a framebuffer that has as many is used
    /// as it is.
    int bits = 32;
    glm::ivec4 viewport{0}; ///< x, y, width, height: largest rectangle that may be drawn to
    bool marched = false;   ///< by volumes that a compute shader could march, to a target only
};

/// One pass over a transparent bin's leaves. begin() takes a copy of the opaque scene's depth, if
/// there is one, for segments to end at, and, where the framebuffer has fewer bits than asked for,
/// redirects drawing to a float target that starts as a copy of the framebuffer, so that any blend
/// function still finds the colours it expects. So it is with several samples a pixel: colours are
/// resolved, depths are those of one sample, and what is drawn between has one; edges of opaque
/// geometry stay smooth. end() writes the result back. Both run in the draw thread, in one context.
///
/// What other outputs of shaders go to (several draw buffers) is drawn to as it would be without
/// volumes, which write the first output alone. Stencil values come to the target and go back where
/// a leaf asks for them.
class Accumulation : public osg::Referenced
{
public:
    explicit Accumulation(const AccumulationSettings& settings);

    void begin(osg::RenderInfo& renderInfo);
    void end(osg::RenderInfo& renderInfo);
    /// Redirects drawing to an empty depth buffer, where surfaces leave their nearest depth...
    /// \param area window rectangle (x, y, width, height) that is cleared and drawn to
    void beginSplit(osg::RenderInfo& renderInfo, const glm::ivec4& area);
    /// ...for segments to be split at.
    void endSplit(osg::RenderInfo& renderInfo);
    /// Between begin and end: whether there is a target, or the framebuffer is drawn to as it is.
    bool hasTarget() const { return _redirected; }
    /// Where surfaces may be drawn by a state that counts stencil values: a target without any.
    bool hasPlainTarget() const { return _redirected && !_stencilUsed; }
    /// Draws to the target again: the framebuffer itself where nothing was redirected.
    void bindTarget(osg::State& state) const;

    /// Before the frame is drawn: there has to be a target, whatever the framebuffer has.
    void requireTarget() { _targetRequired = true; }
    /// Before the frame is drawn: a framebuffer that can be drawn to as it is is, whatever its
    /// bits.
    void keepFramebuffer() { _settings.bits = 8; }
    /// Before the frame is drawn: what surfaces leave in the target's depth is for the framebuffer.
    void keepDepth() { _depthKept = true; }
    bool isDepthKept() const { return _depthKept; }
    /// Before the frame is drawn: leaves test or write stencil values.
    void useStencil() { _stencilUsed = true; }
    /// Before the frame is drawn: nothing is drawn outside this part (x, y, width, height) of the
    /// viewport, so no more has to be copied.
    void restrictTo(const glm::ivec4& area);
    /// Before the frame is drawn: the depth buffer is as it was cleared, to 1, so it is not copied.
    void expectClearedDepth() { _depthCleared = true; }

private:
    bool needsTarget(osg::State& state, ContextResources& resources) const;
    GLenum depthFormat(osg::State& state, AccumulationBuffers& buffers) const;
    void copyOpaqueDepth(osg::State& state, AccumulationBuffers& buffers) const;
    void copyToTarget(osg::State& state, AccumulationBuffers& buffers) const;
    void shareOtherBuffers(osg::State& state, ContextResources& resources) const;
    void blit(osg::GLExtensions& gl, GLuint from, GLuint to, GLbitfield what) const;
    void writeBack(osg::State& state, ContextResources& resources) const;

    AccumulationSettings _settings;
    glm::ivec4 _area;
    bool _redirected = false, _targetRequired = false, _depthKept = false, _depthCleared = false;
    bool _stencilUsed = false, _depthBlitted = false;
    Framebuffer _framebuffer; ///< that begin() found
};

} // namespace render
} // namespace osgVolumizer
