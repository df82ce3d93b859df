#pragma once

#include <osgVolumizer/core/Status.h>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace support {

/// An EGL display without a window system, and how it was come by. Each is opened once and stays
/// open until the process ends: contexts come and go in several threads, and closing a display
/// would invalidate all of them.
class OffscreenDisplay
{
public:
    /// In place of a device's number: Mesa's surfaceless platform, which chooses a device itself.
    static constexpr int SURFACELESS = -1;

    /// The display of EGL's device of a number, from 0. NOT_SUPPORTED tells what failed,
    /// INDEX_OUT_OF_RANGE which devices there are.
    static Result<const OffscreenDisplay*> open(int device);
    /// The first of several that opens; otherwise what failed with each.
    static Result<const OffscreenDisplay*> openFirst(const std::vector<int>& devices);
    /// The device that the environment variable OSGVOLUMIZER_EGL_DEVICE names by its number;
    /// without it the surfaceless platform, else the first device that opens.
    static Result<const OffscreenDisplay*> openDefault();

    /// How many devices EGL lists; 0 where it lists none.
    static int deviceCount();
    /// The number that a text names; VALUE_INVALID or INDEX_OUT_OF_RANGE for no device's.
    static Result<int> parseDevice(const std::string& text);

    /// The device's number, or SURFACELESS.
    int device() const { return _device; }
    /// The EGL extension that the display is of.
    const char* platform() const;
    void* handle() const { return _handle; } ///< EGLDisplay; this header drags in no EGL
    void* config() const { return _config; } ///< EGLConfig of contexts that have no surface

private:
    static OffscreenDisplay opened(int device);

    int _device = SURFACELESS;
    void* _handle = nullptr;
    void* _config = nullptr;
    Status _status;
};

} // namespace support
} // namespace osgVolumizer
