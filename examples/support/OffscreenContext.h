#pragma once

#include "OffscreenDisplay.h"

#include <osgVolumizer/core/Status.h>

#include <memory>
#include <optional>
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

/// An OpenGL context without window or X server (of an OffscreenDisplay), and without a default
/// framebuffer unless one is asked for. Contexts are independent of each other unless they share.
class OffscreenContext
{
public:
    enum Profile
    {
        COMPATIBILITY,
        CORE
    };

    /// Not yet current, on OffscreenDisplay's default, or the device of a number; one that shares
    /// is where the other is. NOT_SUPPORTED where EGL, a display or the profile is missing.
    static Result<std::unique_ptr<OffscreenContext>>
    create(Profile profile = COMPATIBILITY, const OffscreenContext* shared = nullptr,
           std::optional<int> device = {});

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
    const OffscreenDisplay& display() const { return *_display; }

private:
    OffscreenContext(const OffscreenDisplay& display, void* context, void* surface = nullptr)
        : _display(&display), _context(context), _surface(surface)
    {
    }

    const OffscreenDisplay* _display; // of all the process
    void* _context;                   // EGLContext; this header drags in no EGL
    void* _surface;                   // EGLSurface, or null
};

} // namespace support
} // namespace osgVolumizer
