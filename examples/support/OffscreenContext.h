#pragma once

#include <osgVolumizer/core/Status.h>

#include <memory>

namespace osgVolumizer {
namespace support {

/// An OpenGL context without window, surface or X server (EGL, Mesa's surfaceless platform). One
/// display serves the process; contexts are independent of each other unless they share.
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

    /// Expects that the context is current in no other thread.
    ~OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;

    /// For the calling thread. A context is current in at most one thread: EGL refuses a second.
    bool makeCurrent();
    bool release();
    bool isCurrent() const;

private:
    OffscreenContext(void* display, void* context) : _display(display), _context(context) {}

    void* _display; // EGLDisplay; this header drags in no EGL
    void* _context; // EGLContext
};

} // namespace support
} // namespace osgVolumizer
