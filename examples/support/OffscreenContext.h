#pragma once

#include <osgVolumizer/core/Status.h>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace support {

/// What a default framebuffer has, as a window's would: RGBA with 8 bits a channel, and these.
struct SurfaceFormat
{
    int depthBits = 24, stencilBits = 0, samples = 0;

    bool operator==(const SurfaceFormat& o) const
    {
        return depthBits == o.depthBits && stencilBits == o.stencilBits && samples == o.samples;
    }
};

/// An OpenGL context without window or X server (EGL, Mesa's surfaceless platform), and without a
/// default framebuffer unless one is asked for. One display serves the process; contexts are
/// independent of each other unless they share.
class OffscreenContext
{
public:
    enum Profile
    {
        COMPATIBILITY,
        CORE
    };

    /// Not yet current. NOT_SUPPORTED where EGL, the platform or the profile is missing.
    static Result<std::unique_ptr<OffscreenContext>>
    create(Profile profile = COMPATIBILITY, const OffscreenContext* shared = nullptr);

    /// One with a default framebuffer of a format, in the compatibility profile; single buffered.
    static Result<std::unique_ptr<OffscreenContext>> createWithSurface(int width, int height,
                                                                       const SurfaceFormat& format);
    /// The formats that default framebuffers can have here, each once; none without EGL.
    static std::vector<SurfaceFormat> surfaceFormats();

    /// Expects that the context is current in no other thread.
    ~OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;

    /// For the calling thread. A context is current in at most one thread: EGL refuses a second.
    bool makeCurrent();
    bool release();
    bool isCurrent() const;

private:
    OffscreenContext(void* display, void* context, void* surface = nullptr)
        : _display(display), _context(context), _surface(surface)
    {
    }

    void* _display; // EGLDisplay; this header drags in no EGL
    void* _context; // EGLContext
    void* _surface; // EGLSurface, or null
};

} // namespace support
} // namespace osgVolumizer
