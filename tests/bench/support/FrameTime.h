#pragma once

#include "FrameRenderer.h"
#include "ProcessTime.h"

#include <chrono>

namespace osgVolumizer {
namespace bench {

/// What a frame took, in milliseconds.
struct FrameTime
{
    double wall = 0.0;
    double cpu = 0.0; ///< of all threads of the process
};

inline FrameTime timeFrame(FrameRenderer& renderer)
{
    const double cpu = processMilliseconds();
    const auto start = std::chrono::steady_clock::now();
    renderer.frame();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    return {wall.count(), processMilliseconds() - cpu};
}

} // namespace bench
} // namespace osgVolumizer
