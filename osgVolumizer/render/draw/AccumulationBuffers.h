#pragma once

#include "../context/ContextResources.h"

#include <osg/Texture2D>

#include <cstdint>
#include <map>
#include <vector>

namespace osgVolumizer {
namespace render {

/// The colour and depth that volumes are accumulated in, a copy of the opaque scene's depth, and
/// the depth of the surfaces that split segments. One a context, grown to the largest viewport
/// seen.
struct AccumulationBuffers : ContextPart
{
    int width = 0, height = 0;
    GLenum colorFormat = 0, depthFormat = 0;
    GLenum askedFormat = 0;  ///< of colour, which the card may have had no memory for
    unsigned colorCount = 0; ///< of textures that `color` has been
    GLuint framebuffer = 0, splitFramebuffer = 0, opaqueFramebuffer = 0;
    bool hasOpaqueDepth = false; ///< of this frame; else nothing opaque was drawn
    /// Of what is drawn into now, by output location: volumes write the first alone.
    std::vector<GLenum> drawBuffers;
    /// Formats that depths can be blitted to, by the properties of framebuffers met so far.
    std::map<std::uint64_t, GLenum> blitFormats;
    osg::ref_ptr<osg::Texture2D> color, depth, opaqueDepth, splitDepth;
    /// What the shaders of volumes read of surfaces that were sorted for them, in the order of
    /// UNIT_SORTED_FAR and UNIT_SORTED_NEAR. Set by what sorts; null where that was refused.
    osg::ref_ptr<osg::Texture> sortedSurfaces[2];

    void release(osg::GLExtensions& gl) override;
};

/// Each of these makes what is missing, or too small, or of another format, and returns whether it
/// is there: what a card refuses is not asked for again in that context at that size (see
/// Allocation.h). They leave bindings of framebuffers undefined. Call in the draw thread.

/// The copy of the opaque scene's depth, for window coordinates below width and height.
bool ensureOpaqueDepth(osg::State& state, AccumulationBuffers& buffers, int width, int height,
                       GLenum depthFormat);
/// The target, as large as the copy of depth: in the first of the colour formats that the card has
/// memory for.
bool ensureTarget(osg::State& state, AccumulationBuffers& buffers,
                  const std::vector<GLenum>& colorFormats);
/// The depth of surfaces that split segments, as large as the copy of depth.
bool ensureSplitDepth(osg::State& state, AccumulationBuffers& buffers);

/// Gives another framebuffer the target's colour, unless that is what it has: `attachedCount` is
/// the colorCount of what was attached last.
void attachTargetColor(osg::State& state, GLuint framebuffer, const AccumulationBuffers& buffers,
                       unsigned& attachedCount);

} // namespace render
} // namespace osgVolumizer
