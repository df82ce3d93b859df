#pragma once

#include <support/SceneRenderer.h>

#include <osg/Camera>

#include <vector>

namespace osgVolumizer {
namespace test {

/// What a framebuffer is made of.
struct FramebufferFormat
{
    std::vector<GLenum> colors = {GL_RGBA32F_ARB}; ///< of the colour attachments, all drawn to
    GLenum depth = GL_DEPTH24_STENCIL8_EXT;        ///< with stencil or without; 0 for none
    GLsizei samples = 0;
    bool textures = false; ///< or render buffers; expects one sample

    bool hasStencil() const
    {
        return depth == GL_DEPTH24_STENCIL8_EXT || depth == GL_DEPTH32F_STENCIL8;
    }
};

/// What a frame left in it.
struct FramebufferContents
{
    std::vector<support::FloatImage> colors; ///< the first one with depths, if there are any
    std::vector<unsigned char> stencil;      ///< of the pixels, or empty
    unsigned glError = 0;                    ///< the first of the frame

    bool empty() const { return colors.empty(); }
};

/// A framebuffer of any format that a camera draws to as if it were the window: it becomes the
/// context's own, where whatever is drawn on the way returns to.
class Framebuffer : public osg::Camera::DrawCallback
{
public:
    Framebuffer(int width, int height, const FramebufferFormat& format)
        : _width(width), _height(height), _format(format)
    {
    }
    /// Takes the camera's initial and final draw callback.
    void drawTo(osg::Camera& camera);
    /// Of the last frame; empty where the format is none that GL offers.
    const FramebufferContents& contents() const { return _contents; }

    /// Binds it before a frame, reads it after.
    void operator()(osg::RenderInfo& info) const override;

private:
    GLuint make(osg::GLExtensions& gl, GLsizei samples) const;
    void read(osg::GLExtensions& gl) const;
    void resolve(osg::GLExtensions& gl) const;

    const int _width, _height;
    const FramebufferFormat _format;
    mutable GLuint _drawn = 0, _resolved = 0;
    mutable bool _complete = false, _drawing = false;
    mutable FramebufferContents _contents;
};

/// Renders a scene to a Framebuffer, frame by frame in one context. Format, threading and the
/// number of frames of the options do not matter.
class FramebufferRenderer
{
public:
    FramebufferRenderer(osg::Node* scene, const support::RenderOptions& options,
                        const FramebufferFormat& format);

    FramebufferContents render();
    osg::Camera& camera() { return *_viewer->getCamera(); }
    void setScene(osg::Node* scene) { _viewer->setSceneData(scene); }
    /// Goes on in the same context.
    void setFormat(const FramebufferFormat& format);

private:
    const int _width, _height;
    osg::ref_ptr<Framebuffer> _framebuffer;
    osg::ref_ptr<osgViewer::Viewer> _viewer;
};

} // namespace test
} // namespace osgVolumizer
