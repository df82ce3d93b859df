#pragma once

#include "FloatImage.h"

#include <osgVolumizer/core/Status.h>

#include <string>

namespace osgVolumizer {
namespace support {

/// Writes 32-bit float RGBA as it is: linear, premultiplied, top row first. Any format of
/// OpenImageIO that holds floats (.exr, .tif).
Status writeFloatPicture(const FloatImage& image, const std::string& fileName);
/// Writes 8-bit RGBA for people: the bytes that a window of OSG would show, without a transfer
/// curve, clamped to [0, 1] and with straight alpha, as PNG has it.
Status writeDisplayPicture(const FloatImage& image, const std::string& fileName);
/// writeDisplayPicture() for .png and .jpg, else writeFloatPicture().
Status writePicture(const FloatImage& image, const std::string& fileName);
/// Reads what writeFloatPicture() wrote; missing channels are 0, a missing alpha 1.
Result<FloatImage> readFloatPicture(const std::string& fileName);

} // namespace support
} // namespace osgVolumizer
