#include "OffscreenContext.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
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

// What a configuration of the display has; colours with 8 bits a channel, else nothing.
bool formatOf(EGLDisplay display, EGLConfig config, SurfaceFormat& format)
{
    const auto get = [=](EGLint attribute) {
        EGLint value = 0;
        eglGetConfigAttrib(display, config, attribute, &value);
        return value;
    };
    format = {get(EGL_DEPTH_SIZE), get(EGL_STENCIL_SIZE), get(EGL_SAMPLES)};
    return get(EGL_RED_SIZE) == 8 && get(EGL_GREEN_SIZE) == 8 && get(EGL_BLUE_SIZE) == 8 &&
           get(EGL_ALPHA_SIZE) == 8 && (get(EGL_SURFACE_TYPE) & EGL_PBUFFER_BIT) &&
           (get(EGL_RENDERABLE_TYPE) & EGL_OPENGL_BIT);
}

std::vector<EGLConfig> allConfigurations()
{
    const Display& d = display();
    EGLint count = 0;
    if (d.problem || !eglGetConfigs(d.handle, nullptr, 0, &count)) return {};
    std::vector<EGLConfig> configs(static_cast<std::size_t>(count));
    eglGetConfigs(d.handle, configs.data(), count, &count);
    return configs;
}

Status noContext(const std::string& why)
{
    return {ErrorCode::NOT_SUPPORTED, "No GL context: " + why + "."};
}

} // namespace

std::vector<SurfaceFormat> OffscreenContext::surfaceFormats()
{
    std::vector<SurfaceFormat> formats;
    SurfaceFormat format;
    for (EGLConfig config : allConfigurations())
        if (formatOf(display().handle, config, format) &&
            std::find(formats.begin(), formats.end(), format) == formats.end())
            formats.push_back(format);
    return formats;
}

Result<std::unique_ptr<OffscreenContext>>
OffscreenContext::createWithSurface(int width, int height, const SurfaceFormat& wanted)
{
    const Display& d = display();
    if (d.problem) return noContext(d.problem);
    if (!eglBindAPI(EGL_OPENGL_API)) return noContext("EGL has no desktop OpenGL");
    SurfaceFormat format;
    for (EGLConfig config : allConfigurations()) {
        if (!formatOf(d.handle, config, format) || !(format == wanted)) continue;
        const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
        const EGLSurface surface = eglCreatePbufferSurface(d.handle, config, size);
        if (surface == EGL_NO_SURFACE) continue;
        const EGLContext context = eglCreateContext(d.handle, config, EGL_NO_CONTEXT, nullptr);
        if (context != EGL_NO_CONTEXT)
            return std::unique_ptr<OffscreenContext>(
                new OffscreenContext(d.handle, context, surface));
        eglDestroySurface(d.handle, surface);
    }
    return noContext("EGL has no surface of the format");
}

Result<std::unique_ptr<OffscreenContext>> OffscreenContext::create(Profile profile,
                                                                   const OffscreenContext* shared)
{
    const Display& d = display();
    if (d.problem) return noContext(d.problem);
    // The bound API is per thread.
    if (!eglBindAPI(EGL_OPENGL_API)) return noContext("EGL has no desktop OpenGL");

    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(d.handle, wanted, &config, 1, &count) || count < 1)
        return noContext("EGL has no OpenGL configuration");

    std::vector<EGLint> attributes;
    if (profile == CORE)
        attributes = {EGL_CONTEXT_MAJOR_VERSION,       3,
                      EGL_CONTEXT_MINOR_VERSION,       3,
                      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    attributes.push_back(EGL_NONE);
    const EGLContext context = eglCreateContext(
        d.handle, config, shared ? shared->_context : EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) return noContext("EGL error " + std::to_string(eglGetError()));
    return std::unique_ptr<OffscreenContext>(new OffscreenContext(d.handle, context));
}

OffscreenContext::~OffscreenContext()
{
    if (isCurrent()) release();
    eglDestroyContext(_display, _context);
    if (_surface) eglDestroySurface(_display, _surface);
}

bool OffscreenContext::makeCurrent()
{
    eglBindAPI(EGL_OPENGL_API);
    const EGLSurface surface = _surface ? _surface : EGL_NO_SURFACE;
    return eglMakeCurrent(_display, surface, surface, _context) == EGL_TRUE;
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
