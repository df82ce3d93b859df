#pragma once

#include "OffscreenContext.h"

#include <osg/FrameBufferObject>
#include <osg/GraphicsContext>

#include <memory>
#include <optional>
#include <string>

namespace osgVolumizer {
namespace support {

/// Which device draws, and how it was opened.
struct DrawingDevice
{
    std::string renderer; ///< GL_RENDERER
    std::string platform; ///< OffscreenDisplay::platform()
    int number = OffscreenDisplay::SURFACELESS;
};

/// An OffscreenContext as OSG wants it: give it to a camera of any osgViewer::Viewer or
/// CompositeViewer, in any threading model. Unless it is given a window it has no default
/// framebuffer, so its cameras render to FRAME_BUFFER_OBJECT. Each has a context id of its own.
class SurfacelessGraphicsContext : public osg::GraphicsContext
{
public:
    /// Width and height are those reported to cameras; nothing is allocated for them.
    SurfacelessGraphicsContext(int width, int height,
                               OffscreenContext::Profile profile = OffscreenContext::COMPATIBILITY,
                               std::optional<int> device = {});

    /// One that has a default framebuffer of a format, as a window has.
    SurfacelessGraphicsContext(int width, int height, const SurfaceFormat& format);

    /// What cameras draw to that have no framebuffer object of their own, and what is bound again
    /// after those that have one. Expects that the context is not realized yet.
    void setWindow(osg::FrameBufferObject* window) { _window = window; }

    /// Why the context is not valid().
    const Status& status() const { return _status; }
    /// Once realized.
    const DrawingDevice& device() const { return _device; }

    bool valid() const override { return _context != nullptr; }
    bool realizeImplementation() override;
    bool isRealizedImplementation() const override { return _realized; }
    void closeImplementation() override;
    bool makeCurrentImplementation() override;
    bool makeContextCurrentImplementation(osg::GraphicsContext* readContext) override;
    bool releaseContextImplementation() override;
    /// Expects never to be called: there is no pbuffer.
    void bindPBufferToTextureImplementation(GLenum buffer) override {}
    void swapBuffersImplementation() override {}

    bool isSameKindAs(const Object* object) const override;
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "SurfacelessGraphicsContext"; }

protected:
    ~SurfacelessGraphicsContext() override;

private:
    void initialize(int width, int height, Result<std::unique_ptr<OffscreenContext>> context);
    void bindWindow();

    std::unique_ptr<OffscreenContext> _context;
    osg::ref_ptr<osg::FrameBufferObject> _window;
    Status _status;
    DrawingDevice _device;
    bool _realized = false;
};

} // namespace support
} // namespace osgVolumizer
