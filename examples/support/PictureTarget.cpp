#include "PictureTarget.h"

#include <osg/FrameBufferObject>
#include <osg/GL>
#include <osg/RenderInfo>
#include <osg/State>

#include <chrono>

namespace osgVolumizer {
namespace support {
namespace {

constexpr auto patience = std::chrono::seconds(60);

osg::ref_ptr<osg::Texture2D> makeTexture(int width, int height, GLint internalFormat, GLenum format,
                                         GLenum type)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(width, height);
    texture->setInternalFormat(internalFormat);
    texture->setSourceFormat(format);
    texture->setSourceType(type);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

} // namespace

class PictureTarget::ReadBack : public osg::Camera::DrawCallback
{
public:
    explicit ReadBack(PictureTarget* target) : _target(target) {}
    void operator()(osg::RenderInfo& info) const override
    {
        osg::ref_ptr<PictureTarget> target;
        if (_target.lock(target)) target->frameDrawn(*info.getState());
    }

private:
    osg::observer_ptr<PictureTarget> _target; // the camera must not keep its target alive
};

PictureTarget::PictureTarget(osg::Camera& camera, int width, int height, Format format)
    : _width(width), _height(height)
{
    makeTextures(format);
    camera.setViewport(0, 0, width, height);
    camera.setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera.attach(osg::Camera::COLOR_BUFFER0, _color.get());
    camera.attach(_depthBuffer, _depth.get());
    camera.setFinalDrawCallback(new ReadBack(this));
}

PictureTarget::PictureTarget(osg::Camera& camera, SurfacelessGraphicsContext& context, int width,
                             int height, Format format)
    : _width(width), _height(height)
{
    makeTextures(format);
    const osg::ref_ptr<osg::FrameBufferObject> window = new osg::FrameBufferObject;
    window->setAttachment(osg::Camera::COLOR_BUFFER0, osg::FrameBufferAttachment(_color.get()));
    window->setAttachment(_depthBuffer, osg::FrameBufferAttachment(_depth.get()));
    context.setWindow(window);
    camera.setViewport(0, 0, width, height);
    camera.setRenderTargetImplementation(osg::Camera::FRAME_BUFFER);
    // Said in every frame, as a window's is: cameras of the scene may have another one.
    camera.setDrawBuffer(GL_COLOR_ATTACHMENT0_EXT);
    camera.setReadBuffer(GL_COLOR_ATTACHMENT0_EXT);
    camera.setFinalDrawCallback(new ReadBack(this));
}

void PictureTarget::makeTextures(Format format)
{
    const bool floats = format == FLOAT32;
    _color = makeTexture(_width, _height, floats ? GL_RGBA32F_ARB : GL_RGBA8, GL_RGBA,
                         floats ? GL_FLOAT : GL_UNSIGNED_BYTE);
    _depth = makeTexture(_width, _height, floats ? GL_DEPTH_COMPONENT32F : GL_DEPTH24_STENCIL8_EXT,
                         floats ? GL_DEPTH_COMPONENT : GL_DEPTH_STENCIL_EXT,
                         floats ? GL_FLOAT : GL_UNSIGNED_INT_24_8_EXT);
    _depthBuffer = floats ? osg::Camera::DEPTH_BUFFER : osg::Camera::PACKED_DEPTH_STENCIL_BUFFER;
}

void PictureTarget::request(unsigned n, bool withDepth)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _frames = 0;
    _requested = n;
    _withDepth = withDepth;
    _image = FloatImage();
}

void PictureTarget::frameDrawn(osg::State& state)
{
    glFinish();
    const GLenum error = glGetError();

    const std::lock_guard<std::mutex> lock(_mutex);
    if (error != GL_NO_ERROR && _glError == 0) _glError = error;
    if (++_frames == _requested) {
        _image = FloatImage(_width, _height);
        state.setActiveTextureUnit(0);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        state.applyTextureAttribute(0, _color.get());
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, _image.pixels.data());
        if (_withDepth) {
            _image.depth.resize(_image.pixels.size());
            state.applyTextureAttribute(0, _depth.get());
            glGetTexImage(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, GL_FLOAT, _image.depth.data());
        }
        state.haveAppliedTextureAttribute(0, osg::StateAttribute::TEXTURE);
    }
    _drawn.notify_all();
}

bool PictureTarget::waitForFrames(unsigned n)
{
    std::unique_lock<std::mutex> lock(_mutex);
    return _drawn.wait_for(lock, patience, [&] { return _frames >= n; });
}

FloatImage PictureTarget::wait()
{
    std::unique_lock<std::mutex> lock(_mutex);
    _drawn.wait_for(lock, patience, [&] { return _frames >= _requested; });
    return _image;
}

unsigned PictureTarget::glError() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _glError;
}

} // namespace support
} // namespace osgVolumizer
