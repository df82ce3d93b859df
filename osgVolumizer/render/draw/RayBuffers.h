#pragma once

#include "../context/ContextResources.h"

#include <osg/Program>
#include <osg/Texture2D>

#include <map>
#include <utility>

namespace osgVolumizer {
namespace render {

/// Where values of rays are gathered. One a context, grown to the largest viewport seen.
struct RayBuffers : ContextPart
{
    int width = 0, height = 0;
    GLuint framebuffer = 0;
    osg::ref_ptr<osg::Texture2D> color;
    std::map<std::pair<int, bool>, osg::ref_ptr<osg::Program>> programs; ///< by ray function, rgba

    void release(osg::GLExtensions& gl) override;
};

/// Makes what is missing or too small; false where the card refuses it. Leaves bindings of
/// framebuffers undefined. Call in the draw thread.
bool ensureRays(osg::State& state, RayBuffers& buffers, int width, int height);

} // namespace render
} // namespace osgVolumizer
