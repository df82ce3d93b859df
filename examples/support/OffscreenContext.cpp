#include "OffscreenContext.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <vector>

namespace osgVolumizer {
namespace support {
namespace {

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

std::vector<EGLConfig> allConfigurations(EGLDisplay display)
{
    EGLint count = 0;
    if (!eglGetConfigs(display, nullptr, 0, &count)) return {};
    std::vector<EGLConfig> configs(static_cast<std::size_t>(count));
    eglGetConfigs(display, configs.data(), count, &count);
    return configs;
}

Status noContext(const std::string& why)
{
    return {ErrorCode::NOT_SUPPORTED, "No GL context: " + why + "."};
}

} // namespace

std::vector<SurfaceFormat> OffscreenContext::surfaceFormats()
{
    const auto display = OffscreenDisplay::openDefault();
    if (!display.ok()) return {};
    const EGLDisplay handle = (*display)->handle();
    std::vector<SurfaceFormat> formats;
    SurfaceFormat format;
    for (EGLConfig config : allConfigurations(handle))
        if (formatOf(handle, config, format) &&
            std::find(formats.begin(), formats.end(), format) == formats.end())
            formats.push_back(format);
    return formats;
}

Result<std::unique_ptr<OffscreenContext>>
OffscreenContext::createWithSurface(int width, int height, const SurfaceFormat& wanted)
{
    const auto display = OffscreenDisplay::openDefault();
    if (!display.ok()) return display.status;
    const EGLDisplay handle = (*display)->handle();
    if (!eglBindAPI(EGL_OPENGL_API)) return noContext("EGL has no desktop OpenGL");
    SurfaceFormat format;
    for (EGLConfig config : allConfigurations(handle)) {
        if (!formatOf(handle, config, format) || !(format == wanted)) continue;
        const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
        const EGLSurface surface = eglCreatePbufferSurface(handle, config, size);
        if (surface == EGL_NO_SURFACE) continue;
        const EGLContext context = eglCreateContext(handle, config, EGL_NO_CONTEXT, nullptr);
        if (context != EGL_NO_CONTEXT)
            return std::unique_ptr<OffscreenContext>(
                new OffscreenContext(**display, context, surface));
        eglDestroySurface(handle, surface);
    }
    return noContext("EGL has no surface of the format");
}

Result<std::unique_ptr<OffscreenContext>>
OffscreenContext::create(Profile profile, const OffscreenContext* shared, std::optional<int> device)
{
    const auto display = shared   ? Result<const OffscreenDisplay*>(shared->_display)
                         : device ? OffscreenDisplay::open(*device)
                                  : OffscreenDisplay::openDefault();
    if (!display.ok()) return display.status;
    // The bound API is per thread.
    if (!eglBindAPI(EGL_OPENGL_API)) return noContext("EGL has no desktop OpenGL");

    std::vector<EGLint> attributes;
    if (profile == CORE)
        attributes = {EGL_CONTEXT_MAJOR_VERSION,       3,
                      EGL_CONTEXT_MINOR_VERSION,       3,
                      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    attributes.push_back(EGL_NONE);
    const EGLContext context =
        eglCreateContext((*display)->handle(), (*display)->config(),
                         shared ? shared->_context : EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT)
        return noContext("eglCreateContext fails with error " + std::to_string(eglGetError()));
    return std::unique_ptr<OffscreenContext>(new OffscreenContext(**display, context));
}

OffscreenContext::~OffscreenContext()
{
    if (isCurrent()) release();
    eglDestroyContext(_display->handle(), _context);
    if (_surface) eglDestroySurface(_display->handle(), _surface);
}

bool OffscreenContext::makeCurrent()
{
    eglBindAPI(EGL_OPENGL_API);
    const EGLSurface surface = _surface ? _surface : EGL_NO_SURFACE;
    return eglMakeCurrent(_display->handle(), surface, surface, _context) == EGL_TRUE;
}

bool OffscreenContext::release()
{
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(_display->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT) ==
           EGL_TRUE;
}

bool OffscreenContext::isCurrent() const
{
    return eglGetCurrentContext() == _context;
}

} // namespace support
} // namespace osgVolumizer
