#pragma once

#include "../../draw/AccumulationBuffers.h"

#include <osg/Texture2DArray>

namespace osgVolumizer {
namespace render {

/// Buffers that fragments of surfaces are captured in: see CaptureLeaf. One a context, as large as
/// the target.
struct CaptureBuffers : ContextPart
{
    static constexpr int MAXIMUM_SLOTS = 24;

    int width = 0, height = 0, slotCount = 0;
    GLenum colorFormat = 0;
    GLuint framebuffers[MAXIMUM_SLOTS] = {}, sortedFramebuffer = 0, restFramebuffer = 0;
    GLuint queries[MAXIMUM_SLOTS] = {};
    osg::ref_ptr<osg::Texture2DArray> colors, depths, sorted;
    unsigned colorCount = 0; ///< AccumulationBuffers::colorCount of the rest framebuffer's

    void release(osg::GLExtensions& gl) override;
};

/// Textures of CaptureBuffers::sorted: four depths each, then sixteen numbers of slots each.
constexpr int sortedTextures(int slotCount)
{
    return slotCount / 4 + (slotCount + 15) / 16;
}

/// Makes what is missing, of another size or format, or has fewer slots; false without a target,
/// and where the card refuses. Leaves bindings of framebuffers undefined. Call in the draw thread.
bool ensureCapture(osg::State& state, const AccumulationBuffers& target, CaptureBuffers& buffers,
                   int slotCount);

} // namespace render
} // namespace osgVolumizer
