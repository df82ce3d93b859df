#pragma once

#include "Child.h"

#include <support/FloatImage.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

/// An X server without a screen, whose picture can be read.
class VirtualDisplay
{
public:
    /// \param folder an empty folder, for the picture and the log
    VirtualDisplay(const std::string& folder, int width, int height)
        : _screen(folder + "/Xvfb_screen0")
    {
        int ends[2];
        if (pipe(ends) != 0) return;
        const std::string size = std::to_string(width) + "x" + std::to_string(height) + "x24";
        _server = std::make_unique<Child>(
            std::vector<std::string>{XVFB, "-displayfd", std::to_string(ends[1]), "-fbdir", folder,
                                     "-screen", "0", size, "-nolisten", "tcp"},
            std::map<std::string, std::string>{}, folder + "/Xvfb.log");
        close(ends[1]);
        // The server writes its number when it is ready, or goes.
        for (char c; ::read(ends[0], &c, 1) == 1 && c != '\n';)
            _number += c;
        close(ends[0]);
    }

    bool ready() const { return !_number.empty(); }
    std::string name() const { return ":" + _number; }
    /// What is on the screen; nothing where that cannot be read. The file is an X window dump:
    /// 25 numbers of 32 bits, big-endian, a name, colours of 12 bytes, then rows from the top.
    std::optional<osgVolumizer::support::FloatImage> read() const
    {
        std::ifstream stream(_screen, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
        if (bytes.size() < 100) return {};
        const std::size_t width = number(bytes, 4), height = number(bytes, 5);
        const std::size_t bitsPerPixel = number(bytes, 11), stride = number(bytes, 12);
        const std::size_t start = number(bytes, 0) + 12 * std::size_t(number(bytes, 19));
        if (bitsPerPixel != 32 || bytes.size() < start + stride * height) return {};
        osgVolumizer::support::FloatImage image(static_cast<int>(width), static_cast<int>(height));
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x) {
                const char* p = bytes.data() + start + y * stride + 4 * x;
                glm::vec4& pixel = image.pixels[(height - 1 - y) * width + x];
                for (int c = 0; c < 3; ++c)
                    pixel[2 - c] = static_cast<float>(static_cast<unsigned char>(p[c])) / 255.0f;
                pixel.w = 1.0f;
            }
        return image;
    }

private:
    static std::uint32_t number(const std::string& bytes, std::size_t index)
    {
        std::uint32_t value = 0;
        for (std::size_t i = 4 * index; i < 4 * index + 4; ++i)
            value = value << 8 | static_cast<unsigned char>(bytes[i]);
        return value;
    }

    std::string _screen, _number;
    std::unique_ptr<Child> _server;
};
