#pragma once

#include <support/FloatImage.h>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace support {

/// One flag a pixel, as in FloatImage.
struct Mask
{
    int width = 0;
    int height = 0;
    std::vector<unsigned char> set;

    std::size_t count() const;
};

/// The pixels whose alpha is above `alpha`.
Mask coveredPixels(const FloatImage& image, float alpha = 0.0f);
Mask operator&(const Mask& a, const Mask& b);
Mask operator|(const Mask& a, const Mask& b);
/// The pixels all of whose neighbours up to `radius` away (a square) are set; the border of the
/// picture counts as set.
Mask eroded(const Mask& mask, int radius);

/// How far picture a is from picture b, over the pixels of a mask and all four channels.
struct Difference
{
    double rmse = 0.0;    ///< root of the mean square over pixels and channels
    double maximum = 0.0; ///< largest absolute difference; infinite where a or b is not finite
    double bias = 0.0;    ///< mean of a - b over pixels and channels
    std::size_t pixels = 0;
    int worstX = -1, worstY = -1; ///< where the maximum is
};

/// Without a mask: the pixels that either picture covers. Expects pictures of one size; sizes that
/// differ, and a mask without pixels, give infinite differences, so that no comparison passes by
/// comparing nothing.
Difference compare(const FloatImage& a, const FloatImage& b);
Difference compare(const FloatImage& a, const FloatImage& b, const Mask& mask);

/// The order p of error = c * step^p: the slope of the least squares line through the logarithms.
/// Expects at least two positive steps that differ, and positive errors; else NaN.
double convergenceOrder(const std::vector<double>& steps, const std::vector<double>& errors);

/// Writes a picture for people to the build folder's pictures/: NAME.exr and NAME.png.
void savePicture(const FloatImage& image, const std::string& name);

} // namespace support
} // namespace osgVolumizer
