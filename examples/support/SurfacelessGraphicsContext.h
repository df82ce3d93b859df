#pragma once

#include "OffscreenContext.h"

#include <osg/GraphicsContext>

#include <memory>

namespace osgVolumizer {
namespace support {

/// An OffscreenContext as OSG wants it: give it to a camera of any osgViewer::Viewer or
/// CompositeViewer, in any threading model. Unless it is asked for one it has no default
/// framebuffer, so its cameras render to FRAME_BUFFER_OBJECT. Each has a context id of its own.
class SurfacelessGraphicsContext : public osg::GraphicsContext
{
public:
    /// Width and height are those reported to cameras; nothing is allocated for them.
    SurfacelessGraphicsContext(int width, int height,
                               OffscreenContext::Profile profile = OffscreenContext::COMPATIBILITY);

    /// One that has a default framebuffer of a format, as a window has.
    SurfacelessGraphicsContext(int width, int height, const SurfaceFormat& format);

    /// Why the context is not valid().
    const Status& status() const { return _status; }

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

    std::unique_ptr<OffscreenContext> _context;
    Status _status;
    bool _realized = false;
};

} // namespace support
} // namespace osgVolumizer
