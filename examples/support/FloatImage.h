#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace support {

/// A picture of linear, premultiplied RGBA floats. Row 0 is at the bottom, as in GL: pixel (x, y)
/// shows the ray through window coordinates (x + 0.5, y + 0.5).
struct FloatImage
{
    int width = 0;
    int height = 0;
    std::vector<glm::vec4> pixels; ///< width * height, rows from the bottom up
    std::vector<float> depth;      ///< window depth in [0, 1] of the same pixels, or empty

    FloatImage() = default;
    FloatImage(int w, int h, const glm::vec4& fill = glm::vec4(0.0f))
        : width(w), height(h),
          pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill)
    {
    }

    bool empty() const { return pixels.empty(); }
    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
    const glm::vec4& at(int x, int y) const { return pixels[index(x, y)]; }
    glm::vec4& at(int x, int y) { return pixels[index(x, y)]; }
};

} // namespace support
} // namespace osgVolumizer
