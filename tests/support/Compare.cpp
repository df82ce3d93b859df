#include "Compare.h"

#include <support/PictureFile.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>

namespace osgVolumizer {
namespace support {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Combine>
Mask combined(const Mask& a, const Mask& b, Combine combine)
{
    Mask result = a;
    for (std::size_t i = 0; i < result.set.size() && i < b.set.size(); ++i)
        result.set[i] = combine(a.set[i], b.set[i]);
    return result;
}

} // namespace

std::size_t Mask::count() const
{
    return static_cast<std::size_t>(
        std::count_if(set.begin(), set.end(), [](unsigned char s) { return s != 0; }));
}

Mask coveredPixels(const FloatImage& image, float alpha)
{
    Mask mask{image.width, image.height, {}};
    mask.set.reserve(image.pixels.size());
    for (const glm::vec4& p : image.pixels)
        mask.set.push_back(p.a > alpha);
    return mask;
}

Mask operator&(const Mask& a, const Mask& b)
{
    return combined(a, b, [](unsigned char x, unsigned char y) { return x && y; });
}

Mask operator|(const Mask& a, const Mask& b)
{
    return combined(a, b, [](unsigned char x, unsigned char y) { return x || y; });
}

Mask eroded(const Mask& mask, int radius)
{
    Mask result = mask;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            bool all = true;
            for (int v = std::max(0, y - radius); v <= std::min(mask.height - 1, y + radius); ++v)
                for (int u = std::max(0, x - radius); u <= std::min(mask.width - 1, x + radius);
                     ++u)
                    all = all && mask.set[std::size_t(v) * mask.width + u];
            result.set[std::size_t(y) * mask.width + x] = all;
        }
    return result;
}

Difference compare(const FloatImage& a, const FloatImage& b)
{
    return compare(a, b, coveredPixels(a) | coveredPixels(b));
}

Difference compare(const FloatImage& a, const FloatImage& b, const Mask& mask)
{
    Difference d;
    d.pixels = mask.count();
    if (a.width != b.width || a.height != b.height || mask.set.size() != a.pixels.size() ||
        d.pixels == 0) {
        d.rmse = d.maximum = d.bias = infinity;
        return d;
    }
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (!mask.set[i]) continue;
        for (int c = 0; c < 4; ++c) {
            const double e = double(a.pixels[i][c]) - double(b.pixels[i][c]);
            const double size = std::isfinite(e) ? std::abs(e) : infinity;
            sum += e;
            squares += e * e;
            if (size <= d.maximum && d.worstX >= 0) continue;
            d.maximum = size;
            d.worstX = int(i % std::size_t(a.width));
            d.worstY = int(i / std::size_t(a.width));
        }
    }
    const double n = 4.0 * double(d.pixels);
    d.bias = sum / n;
    d.rmse = std::isfinite(squares) ? std::sqrt(squares / n) : infinity;
    return d;
}

double convergenceOrder(const std::vector<double>& steps, const std::vector<double>& errors)
{
    const std::size_t n = std::min(steps.size(), errors.size());
    double meanX = 0.0, meanY = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        meanX += std::log(steps[i]) / double(n);
        meanY += std::log(errors[i]) / double(n);
    }
    double xy = 0.0, xx = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = std::log(steps[i]) - meanX;
        xy += x * (std::log(errors[i]) - meanY);
        xx += x * x;
    }
    return xx > 0.0 ? xy / xx : std::numeric_limits<double>::quiet_NaN();
}

void savePicture(const FloatImage& image, const std::string& name)
{
    const std::filesystem::path folder = OSGVOLUMIZER_PICTURE_DIR;
    std::error_code ignored; // the pictures are for people: no test depends on them
    std::filesystem::create_directories(folder, ignored);
    for (const char* extension : {".exr", ".png"}) {
        const Status status = writePicture(image, (folder / (name + extension)).string());
        if (!status.ok()) std::cerr << status.text << "\n";
    }
}

} // namespace support
} // namespace osgVolumizer
