#pragma once

#include "FloatImage.h"
#include "SurfacelessGraphicsContext.h"

#include <osg/Camera>
#include <osg/Texture2D>

#include <condition_variable>
#include <mutex>

namespace osgVolumizer {
namespace support {

/// Makes a camera render to textures, and reads the picture of one chosen frame back, in whichever
/// thread draws. It takes the camera's final draw callback.
class PictureTarget : public osg::Referenced
{
public:
    enum Format
    {
        FLOAT32, ///< RGBA32F: nothing is clamped or rounded
        BYTE     ///< RGBA8, as windows have
    };

    /// Sets viewport, render target and callback of `camera`; depth has 32 bit float values, or 24
    /// bit with stencil for BYTE. The textures are a framebuffer object of the camera's own: what
    /// cameras of its scene draw to the window is not in the picture.
    PictureTarget(osg::Camera& camera, int width, int height, Format format = FLOAT32);
    /// The textures are what the context has as its window, for `camera` and those of its scene.
    /// Expects that the context is not realized yet, and has no other window.
    PictureTarget(osg::Camera& camera, SurfacelessGraphicsContext& context, int width, int height,
                  Format format = FLOAT32);

    /// Asks for the picture of the n-th frame drawn from now on, n >= 1.
    void request(unsigned n, bool withDepth = false);
    /// Blocks until n frames were drawn and finished by GL since request(); false after a minute.
    bool waitForFrames(unsigned n);
    /// Blocks until the requested picture is there; empty after a minute without one.
    FloatImage wait();
    /// The first GL error met at the end of a frame, or 0.
    unsigned glError() const;

protected:
    ~PictureTarget() override = default;

private:
    class ReadBack;

    void makeTextures(Format format);
    void frameDrawn(osg::State& state);

    osg::ref_ptr<osg::Texture2D> _color;
    osg::ref_ptr<osg::Texture2D> _depth;
    osg::Camera::BufferComponent _depthBuffer = osg::Camera::DEPTH_BUFFER;
    int _width;
    int _height;

    mutable std::mutex _mutex;
    std::condition_variable _drawn;
    unsigned _frames = 0;
    unsigned _requested = 0;
    bool _withDepth = false;
    unsigned _glError = 0;
    FloatImage _image;
};

} // namespace support
} // namespace osgVolumizer
