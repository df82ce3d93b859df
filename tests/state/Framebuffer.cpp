#include "Framebuffer.h"

#include <osg/RenderInfo>
#include <osg/State>

namespace osgVolumizer {
namespace test {

void Framebuffer::drawTo(osg::Camera& camera)
{
    camera.setRenderTargetImplementation(osg::Camera::FRAME_BUFFER);
    camera.setViewport(0, 0, _width, _height);
    camera.setInitialDrawCallback(this);
    camera.setFinalDrawCallback(this);
}

// Its buffers live as long as the context.
GLuint Framebuffer::make(osg::GLExtensions& gl, GLsizei samples) const
{
    GLuint name = 0;
    gl.glGenFramebuffers(1, &name);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, name);
    const auto attach = [&](GLenum attachment, GLenum format) {
        GLuint buffer = 0;
        if (_format.textures) {
            glGenTextures(1, &buffer);
            glBindTexture(GL_TEXTURE_2D, buffer);
            gl.glTexStorage2D(GL_TEXTURE_2D, 1, format, _width, _height);
            glBindTexture(GL_TEXTURE_2D, 0);
            gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, attachment, GL_TEXTURE_2D, buffer, 0);
            return;
        }
        gl.glGenRenderbuffers(1, &buffer);
        gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, buffer);
        gl.glRenderbufferStorageMultisample(GL_RENDERBUFFER_EXT, samples, format, _width, _height);
        gl.glFramebufferRenderbuffer(GL_FRAMEBUFFER_EXT, attachment, GL_RENDERBUFFER_EXT, buffer);
    };
    std::vector<GLenum> targets;
    for (const GLenum color : _format.colors) {
        targets.push_back(GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(targets.size()));
        attach(targets.back(), color);
    }
    gl.glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
    if (_format.depth)
        attach(_format.hasStencil() ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT_EXT,
               _format.depth);
    return name;
}

void Framebuffer::operator()(osg::RenderInfo& info) const
{
    osg::GLExtensions& gl = *info.getState()->get<osg::GLExtensions>();
    if (!_drawn) {
        _drawn = make(gl, _format.samples);
        _complete = gl.glCheckFramebufferStatus(GL_FRAMEBUFFER_EXT) == GL_FRAMEBUFFER_COMPLETE_EXT;
        _resolved = _format.samples > 0 ? make(gl, 0) : _drawn;
        info.getState()->getGraphicsContext()->setDefaultFboId(_drawn);
        while (glGetError() != GL_NO_ERROR) // GL need not offer the format
            _complete = false;
    }
    _drawing = !_drawing;
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, _drawn);
    if (_drawing || !_complete) return;
    _contents = FramebufferContents();
    _contents.glError = glGetError();
    resolve(gl);
    read(gl);
}

void Framebuffer::resolve(osg::GLExtensions& gl) const
{
    if (_resolved == _drawn) return;
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, _drawn);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, _resolved);
    for (std::size_t i = 0; i < _format.colors.size(); ++i) {
        const GLenum buffer = GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(i);
        glReadBuffer(buffer);
        glDrawBuffer(buffer);
        gl.glBlitFramebuffer(0, 0, _width, _height, 0, 0, _width, _height, GL_COLOR_BUFFER_BIT,
                             GL_NEAREST);
    }
    glReadBuffer(GL_COLOR_ATTACHMENT0_EXT);
    gl.glBlitFramebuffer(0, 0, _width, _height, 0, 0, _width, _height,
                         (_format.depth ? GL_DEPTH_BUFFER_BIT : 0u) |
                             (_format.hasStencil() ? GL_STENCIL_BUFFER_BIT : 0u),
                         GL_NEAREST);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, _resolved);
}

void Framebuffer::read(osg::GLExtensions& gl) const
{
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (std::size_t i = 0; i < _format.colors.size(); ++i) {
        _contents.colors.emplace_back(_width, _height);
        glReadBuffer(GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(i));
        glReadPixels(0, 0, _width, _height, GL_RGBA, GL_FLOAT,
                     _contents.colors.back().pixels.data());
    }
    glReadBuffer(GL_COLOR_ATTACHMENT0_EXT);
    const std::size_t count = std::size_t(_width) * std::size_t(_height);
    if (_format.depth) {
        _contents.colors.front().depth.resize(count);
        glReadPixels(0, 0, _width, _height, GL_DEPTH_COMPONENT, GL_FLOAT,
                     _contents.colors.front().depth.data());
    }
    if (_format.hasStencil()) {
        _contents.stencil.resize(count);
        glReadPixels(0, 0, _width, _height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE,
                     _contents.stencil.data());
    }
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, _drawn);
}

FramebufferRenderer::FramebufferRenderer(osg::Node* scene, const support::RenderOptions& options,
                                         const FramebufferFormat& format)
    : _width(options.width), _height(options.height), _viewer(new osgViewer::Viewer)
{
    osg::Camera* camera = _viewer->getCamera();
    camera->setGraphicsContext(
        new support::SurfacelessGraphicsContext(options.width, options.height, options.profile));
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    camera->setViewMatrix(options.view);
    camera->setProjectionMatrix(options.projection);
    camera->setClearColor(options.background);
    camera->setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    camera->setComputeNearFarMode(options.computeNearFar
                                      ? osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES
                                      : osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    setFormat(format);
    _viewer->setLightingMode(options.light ? osg::View::HEADLIGHT : osg::View::NO_LIGHT);
    _viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    _viewer->setKeyEventSetsDone(0);
    _viewer->setSceneData(scene);
    _viewer->realize();
}

void FramebufferRenderer::setFormat(const FramebufferFormat& format)
{
    _framebuffer = new Framebuffer(_width, _height, format);
    _framebuffer->drawTo(camera());
}

FramebufferContents FramebufferRenderer::render()
{
    _viewer->frame();
    return _framebuffer->contents();
}

} // namespace test
} // namespace osgVolumizer
