#include "OffscreenContext.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstring>
#include <vector>

namespace osgVolumizer {
namespace support {
namespace {

bool hasExtension(const char* list, const char* name)
{
    if (!list) return false;
    const std::size_t length = std::strlen(name);
    for (const char* p = list; (p = std::strstr(p, name)); p += length) {
        const bool starts = p == list || p[-1] == ' ';
        if (starts && (p[length] == ' ' || p[length] == '\0')) return true;
    }
    return false;
}

struct Display
{
    EGLDisplay handle = EGL_NO_DISPLAY;
    const char* problem = nullptr;
};

Display openDisplay()
{
    Display d;
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!hasExtension(client, "EGL_MESA_platform_surfaceless")) {
        d.problem = "EGL has no surfaceless platform";
        return d;
    }
    const auto getDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (getDisplay)
        d.handle = getDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (d.handle == EGL_NO_DISPLAY || !eglInitialize(d.handle, nullptr, nullptr))
        d.problem = "the surfaceless EGL display does not open";
    else if (!hasExtension(eglQueryString(d.handle, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
        d.problem = "EGL has no surfaceless contexts";
    return d;
}

// Stays open until the process ends: contexts come and go in several threads, and closing the
// display would invalidate them all.
const Display& display()
{
    static const Display instance = openDisplay();
    return instance;
}

} // namespace

Result<std::unique_ptr<OffscreenContext>> OffscreenContext::create(Profile profile,
                                                                   const OffscreenContext* shared)
{
    const Display& d = display();
    if (d.problem)
        return Status(ErrorCode::NOT_SUPPORTED, std::string("No GL context: ") + d.problem + ".");
    // The bound API is per thread.
    if (!eglBindAPI(EGL_OPENGL_API))
        return Status(ErrorCode::NOT_SUPPORTED, "No GL context: EGL has no desktop OpenGL.");

    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(d.handle, wanted, &config, 1, &count) || count < 1)
        return Status(ErrorCode::NOT_SUPPORTED, "No GL context: EGL has no OpenGL configuration.");

    std::vector<EGLint> attributes;
    if (profile == CORE)
        attributes = {EGL_CONTEXT_MAJOR_VERSION,       3,
                      EGL_CONTEXT_MINOR_VERSION,       3,
                      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    attributes.push_back(EGL_NONE);
    const EGLContext context = eglCreateContext(
        d.handle, config, shared ? shared->_context : EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT)
        return Status(ErrorCode::NOT_SUPPORTED,
                      "No GL context: EGL error " + std::to_string(eglGetError()) + ".");
    return std::unique_ptr<OffscreenContext>(new OffscreenContext(d.handle, context));
}

OffscreenContext::~OffscreenContext()
{
    if (isCurrent()) release();
    eglDestroyContext(_display, _context);
}

bool OffscreenContext::makeCurrent()
{
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, _context) == EGL_TRUE;
}

bool OffscreenContext::release()
{
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT) == EGL_TRUE;
}

bool OffscreenContext::isCurrent() const
{
    return eglGetCurrentContext() == _context;
}

} // namespace support
} // namespace osgVolumizer
