#pragma once

#include "../../draw/AccumulationBuffers.h"

#include <osg/Texture2D>

namespace osgVolumizer {
namespace render {

/// Buffers that surfaces are sorted in, rank by rank: see RankLeaf. One a context, as large as the
/// target.
struct RankBuffers : ContextPart
{
    static constexpr int COUNT = 8; ///< of depths that are sorted

    int width = 0, height = 0;
    GLuint framebuffers[COUNT] = {}, sortedFramebuffer = 0, rankFramebuffer = 0;
    GLuint queries[COUNT] = {};
    osg::ref_ptr<osg::Texture2D> depths[COUNT], sorted[2], rankDepth; ///< null until needed
    unsigned colorCount = 0; ///< AccumulationBuffers::colorCount of the rank framebuffer's

    void release(osg::GLExtensions& gl) override;
};

/// Makes what is missing or of another size; false without a target, and where the card refuses.
/// Leaves bindings of framebuffers undefined. Call in the draw thread.
bool ensureRanks(osg::State& state, const AccumulationBuffers& target, RankBuffers& buffers);

} // namespace render
} // namespace osgVolumizer
