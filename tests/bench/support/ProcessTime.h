#pragma once

#include <ctime>

namespace osgVolumizer {
namespace bench {

/// CPU time of the whole process: with a software rasteriser what a frame costs, whatever else the
/// machine does.
inline double processMilliseconds()
{
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

} // namespace bench
} // namespace osgVolumizer
