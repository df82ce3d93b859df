#pragma once

#include <support/FloatImage.h>

#include <glm/vec4.hpp>

#include <atomic>
#include <thread>
#include <vector>

namespace osgVolumizer {
namespace oracle {

/// A picture whose pixel (x, y) is perPixel(x, y), a glm::dvec4, in as many threads as there are
/// cores, row by row.
template <class PerPixel>
support::FloatImage forEachPixel(int width, int height, PerPixel perPixel)
{
    support::FloatImage image(width, height);
    std::atomic<int> nextRow{0};
    const auto work = [&] {
        for (int y = nextRow++; y < height; y = nextRow++)
            for (int x = 0; x < width; ++x)
                image.at(x, y) = glm::vec4(perPixel(x, y));
    };
    std::vector<std::thread> others;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
        others.emplace_back(work);
    work();
    for (std::thread& thread : others)
        thread.join();
    return image;
}

} // namespace oracle
} // namespace osgVolumizer
