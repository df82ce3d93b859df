#include "OffscreenDisplay.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

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

// Of EGL itself, before there is a display.
bool clientHas(const char* name)
{
    return hasExtension(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), name);
}

template <class Function>
Function find(const char* name)
{
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::vector<EGLDeviceEXT> allDevices()
{
    if (!clientHas("EGL_EXT_device_base") && !clientHas("EGL_EXT_device_enumeration")) return {};
    const auto query = find<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLint count = 0;
    if (!query || !query(0, nullptr, &count) || count < 1) return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (!query(count, devices.data(), &count)) return {};
    devices.resize(static_cast<std::size_t>(std::max(count, 0)));
    return devices;
}

const std::string NO_CONTEXT = "No GL context: ";

Status noDisplay(const std::string& why)
{
    return {ErrorCode::NOT_SUPPORTED, NO_CONTEXT + why + "."};
}

// What noDisplay() was told, or another sentence without its full stop.
std::string reasonOf(const Status& status)
{
    const std::string& text = status.text;
    const std::size_t begin =
        text.compare(0, NO_CONTEXT.size(), NO_CONTEXT) ? 0 : NO_CONTEXT.size();
    return text.substr(begin, text.size() - begin - 1);
}

Status noDevice(const std::string& name)
{
    const int count = OffscreenDisplay::deviceCount();
    const std::string there = count == 0   ? "EGL lists none"
                              : count == 1 ? "EGL lists device 0 alone"
                                           : "EGL lists 0 to " + std::to_string(count - 1);
    return {ErrorCode::INDEX_OUT_OF_RANGE, "There is no EGL device '" + name + "'; " + there + "."};
}

std::string nameOf(int device)
{
    return device == OffscreenDisplay::SURFACELESS ? "EGL's surfaceless display"
                                                   : "EGL device " + std::to_string(device);
}

// With the error of the last call of EGL.
Status failed(int device, const std::string& what)
{
    char error[16];
    std::snprintf(error, sizeof(error), "0x%04x", static_cast<unsigned>(eglGetError()));
    return noDisplay(nameOf(device) + " " + what + " (EGL error " + error + ")");
}

Result<EGLDisplay> displayOf(int device)
{
    const bool surfaceless = device == OffscreenDisplay::SURFACELESS;
    if (surfaceless && !clientHas("EGL_MESA_platform_surfaceless"))
        return noDisplay("EGL has no surfaceless platform");
    if (!surfaceless && !clientHas("EGL_EXT_platform_device"))
        return noDisplay("EGL has no displays of devices");
    const auto get = find<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (!get) return noDisplay("EGL has no eglGetPlatformDisplayEXT");
    const EGLDisplay display =
        surfaceless ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
                    : get(EGL_PLATFORM_DEVICE_EXT, allDevices()[std::size_t(device)], nullptr);
    if (display == EGL_NO_DISPLAY) return failed(device, "has no display");
    if (!eglInitialize(display, nullptr, nullptr)) return failed(device, "does not open");
    return display;
}

// Of contexts without a surface.
Result<EGLConfig> configOf(EGLDisplay display, int device)
{
    if (!hasExtension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
        return noDisplay(nameOf(device) + " has no contexts without a surface");
    if (!eglBindAPI(EGL_OPENGL_API)) return failed(device, "has no desktop OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1)
        return failed(device, "has no OpenGL configuration");
    return config;
}

} // namespace

OffscreenDisplay OffscreenDisplay::opened(int device)
{
    OffscreenDisplay result;
    result._device = device;
    const Result<EGLDisplay> display = displayOf(device);
    result._status = display.status;
    if (!display.ok()) return result;
    const Result<EGLConfig> config = configOf(*display, device);
    result._status = config.status;
    result._handle = *display;
    result._config = *config;
    return result;
}

Result<const OffscreenDisplay*> OffscreenDisplay::open(int device)
{
    static std::mutex mutex;
    static std::map<int, OffscreenDisplay> displays; // what did not open is not tried again
    if (device != SURFACELESS && (device < 0 || device >= deviceCount()))
        return noDevice(std::to_string(device));
    const std::lock_guard<std::mutex> lock(mutex);
    auto found = displays.find(device);
    if (found == displays.end()) found = displays.emplace(device, opened(device)).first;
    if (!found->second._status.ok()) return found->second._status;
    return &found->second;
}

Result<const OffscreenDisplay*> OffscreenDisplay::openFirst(const std::vector<int>& devices)
{
    std::string reasons;
    for (const int device : devices) {
        const Result<const OffscreenDisplay*> display = open(device);
        if (display.ok()) return display;
        reasons += (reasons.empty() ? "" : "; ") + reasonOf(display.status);
    }
    return noDisplay(reasons);
}

Result<const OffscreenDisplay*> OffscreenDisplay::openDefault()
{
    const char* named = std::getenv("OSGVOLUMIZER_EGL_DEVICE");
    if (named && *named) {
        const Result<int> device = parseDevice(named);
        if (device.ok()) return open(*device);
        return Status(device.status.code, "OSGVOLUMIZER_EGL_DEVICE: " + device.status.text);
    }
    std::vector<int> devices{SURFACELESS};
    for (int i = 0; i < deviceCount(); ++i)
        devices.push_back(i);
    return openFirst(devices);
}

int OffscreenDisplay::deviceCount()
{
    return static_cast<int>(allDevices().size());
}

Result<int> OffscreenDisplay::parseDevice(const std::string& text)
{
    const bool digits = !text.empty() && std::all_of(text.begin(), text.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
    if (!digits)
        return Status(ErrorCode::VALUE_INVALID, "'" + text + "' is no number of an EGL device.");
    if (text.size() > 6 || std::stoi(text) >= deviceCount()) return noDevice(text);
    return std::stoi(text);
}

const char* OffscreenDisplay::platform() const
{
    return _device == SURFACELESS ? "EGL_MESA_platform_surfaceless" : "EGL_EXT_platform_device";
}

} // namespace support
} // namespace osgVolumizer
