#pragma once

#include "ContextResources.h"

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
};

/// One pass over a transparent bin's leaves. begin() takes a copy of the opaque scene's depth, if
/// there is one, for segments to end at, and, where the framebuffer has fewer bits than asked for,
/// redirects drawing to a float target that starts as a copy of the framebuffer, so that any blend
/// function still finds the colours it expects. So it is with several samples a pixel: colours are
/// resolved, depths are those of one sample, and what is drawn between has one; edges of opaque
/// geometry stay smooth. end() writes the result back. Both run in the draw thread, in one context.
class Accumulation : public osg::Referenced
{
public:
    explicit Accumulation(const AccumulationSettings& settings)
        : _settings(settings), _area(settings.viewport)
    {
    }

    void begin(osg::RenderInfo& renderInfo);
    void end(osg::RenderInfo& renderInfo);
    /// Redirects drawing to an empty depth buffer, where surfaces leave their nearest depth...
    /// \param area window rectangle (x, y, width, height) that is cleared and drawn to
    void beginLayer(osg::RenderInfo& renderInfo, const glm::ivec4& area);
    /// ...for segments to be split at.
    void endLayer(osg::RenderInfo& renderInfo);

    /// Before the frame is drawn: there has to be a target, whatever the framebuffer has.
    void requireTarget() { _targetRequired = true; }
    /// Before the frame is drawn: what surfaces leave in the target's depth is for the framebuffer.
    void keepDepth() { _depthKept = true; }
    bool isDepthKept() const { return _depthKept; }
    /// Before the frame is drawn: nothing is drawn outside this part (x, y, width, height) of the
    /// viewport, so no more has to be copied.
    void restrictTo(const glm::ivec4& area) { _area = area; }
    /// Before the frame is drawn: the depth buffer is as it was cleared, to 1, so it is not copied.
    void expectClearedDepth() { _depthCleared = true; }
    /// The buffers of sorted layers, made when first asked for, with the target's colour.
    LayerBuffers& layerBuffers(osg::State& state);
    /// The buffers of captured surfaces, with at least so many slots.
    CaptureBuffers& captureBuffers(osg::State& state, int slotCount);

private:
    bool needsTarget(const ContextResources& resources) const;
    void copyTo(osg::State& state, osg::Texture2D& depth, GLuint from) const;
    void copyOpaqueDepth(osg::State& state, AccumulationBuffers& buffers);
    void copyToTarget(osg::State& state, AccumulationBuffers& buffers);
    void blitFrom(osg::GLExtensions& gl, GLuint from, GLuint to, GLbitfield what) const;
    void writeBack(osg::State& state, ContextResources& resources);

    AccumulationSettings _settings;
    glm::ivec4 _area;
    bool _redirected = false, _targetRequired = false, _depthKept = false, _depthCleared = false;
    GLint _drawFramebuffer = 0, _readFramebuffer = 0, _sampleBuffers = 0;
};

/// The leaf that calls one of Accumulation's steps.
class AccumulationLeaf : public osg::Drawable
{
public:
    enum Step
    {
        BEGIN,
        END,
        BEGIN_LAYER,
        END_LAYER
    };

    AccumulationLeaf(Accumulation* accumulation, Step step, const glm::ivec4& area);
    osg::Object* cloneType() const override
    {
        return new AccumulationLeaf(nullptr, BEGIN, glm::ivec4(0));
    }
    osg::Object* clone(const osg::CopyOp&) const override { return cloneType(); }
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "AccumulationLeaf"; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    osg::ref_ptr<Accumulation> _accumulation;
    Step _step;
    glm::ivec4 _area;
};

/// A leaf for a step, among the leaves of the same bin and view as `beside`.
osgUtil::RenderLeaf* accumulationLeaf(Accumulation& accumulation, AccumulationLeaf::Step step,
                                      const osgUtil::RenderLeaf& beside, const glm::ivec4& area);

} // namespace render
} // namespace osgVolumizer
