#pragma once

#include "ContextLimits.h"

#include <osg/GLExtensions>
#include <osg/Program>
#include <osg/State>
#include <osg/Texture2D>
#include <osg/Texture2DArray>

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// A GL buffer of one context that vertices or indices are streamed through.
class StreamBuffer
{
public:
    /// Binds the buffer to `target` and fills it.
    void stream(osg::GLExtensions& gl, GLenum target, const void* data, std::size_t bytes);
    void release(osg::GLExtensions& gl);

private:
    GLuint _name = 0;
};

/// Buffers of the depth layers that sort surfaces: see RankLeaf.
struct LayerBuffers
{
    static constexpr int COUNT = 8;

    GLuint layerFramebuffers[COUNT] = {}, sortedFramebuffer = 0, rankFramebuffer = 0;
    GLuint queries[COUNT] = {};
    osg::ref_ptr<osg::Texture2D> layers[COUNT], sorted[2], rankDepth; ///< null until needed
    unsigned rankColorCount = 0; ///< AccumulationBuffers::colorCount of the rank framebuffer's
};

/// Buffers of captured surfaces: see CaptureLeaf.
struct CaptureBuffers
{
    static constexpr int MAXIMUM_SLOTS = 24;

    int width = 0, height = 0, slotCount = 0;
    GLenum colorFormat = 0;
    GLuint framebuffers[MAXIMUM_SLOTS] = {}, sortedFramebuffer = 0, restFramebuffer = 0;
    GLuint queries[MAXIMUM_SLOTS] = {};
    osg::ref_ptr<osg::Texture2DArray> colors, depths, sorted;
    unsigned restColorCount = 0; ///< AccumulationBuffers::colorCount of the rest framebuffer's
};
/// Layers of `sorted`: four depths each, then sixteen slots each.
constexpr int sortedLayers(int slotCount)
{
    return slotCount / 4 + (slotCount + 15) / 16;
}

/// The colour and depth that volumes are accumulated in, a copy of the opaque scene's depth, and
/// the depth of the surfaces that split segments. One a context, grown to the largest viewport
/// seen.
struct AccumulationBuffers
{
    int width = 0, height = 0;
    GLenum colorFormat = 0, depthFormat = 0;
    GLenum askedFormat = 0;  ///< of colour, which the card may have had no memory for
    unsigned colorCount = 0; ///< of textures that `color` has been
    GLuint framebuffer = 0, layerFramebuffer = 0, opaqueFramebuffer = 0;
    bool hasOpaqueDepth = false; ///< of this frame; else nothing opaque was drawn
    /// Of what is drawn into now, by output location: volumes write the first alone.
    std::vector<GLenum> drawBuffers;
    /// Formats that depths can be blitted to, by the properties of framebuffers met so far.
    std::map<std::uint64_t, GLenum> blitFormats;
    osg::ref_ptr<osg::Texture2D> color, depth, opaqueDepth, layerDepth;
    LayerBuffers layers;
};

/// Where values of rays are gathered. One a context, grown to the largest viewport seen.
struct RayBuffers
{
    int width = 0, height = 0;
    GLuint framebuffer = 0;
    osg::ref_ptr<osg::Texture2D> color;
    std::map<std::pair<int, bool>, osg::ref_ptr<osg::Program>> programs; ///< by ray function, rgba
};

/// What the renderer keeps per context, made when first needed.
struct ContextResources
{
    explicit ContextResources(osg::State& state);

    ContextLimits limits;
    using GetAttachmentParameter = void(GL_APIENTRY*)(GLenum, GLenum, GLenum, GLint*);
    GetAttachmentParameter glGetFramebufferAttachmentParameteriv = nullptr; ///< not one of OSG's
    StreamBuffer vertices, indices;
    AccumulationBuffers accumulation;
    CaptureBuffers capture;
    RayBuffers rays;
};

/// The resources of the current context; call only while it is current. They are released with the
/// context, when OSG deletes or discards its objects.
std::shared_ptr<ContextResources> contextResources(osg::State& state);
/// Of how many contexts there are resources.
std::size_t contextResourcesCount();
/// Follows osg::Object::releaseGLObjects: one context's resources, or all for null.
void releaseContextResources(osg::State* state);

} // namespace render
} // namespace osgVolumizer
