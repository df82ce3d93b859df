#pragma once

#include <unistd.h>

namespace osgVolumizer {
namespace support {

/// Ends the program by SIGALRM where a test that could wait for ever does so. No measure of speed:
/// what is tested takes milliseconds.
class Watchdog
{
public:
    explicit Watchdog(unsigned seconds = 60) { alarm(seconds); }
    ~Watchdog() { alarm(0); }
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;
};

} // namespace support
} // namespace osgVolumizer
