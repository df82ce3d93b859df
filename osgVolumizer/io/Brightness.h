#pragma once

namespace osgVolumizer {
namespace io {

/// One number of three channels (Rec. 709), or the first of fewer.
template <class T>
double brightness(const T* pixel, int channels)
{
    const double first = static_cast<double>(pixel[0]);
    if (channels < 3) return first;
    // Differences, so that grey stays exactly grey.
    return first + 0.7152 * (static_cast<double>(pixel[1]) - first) +
           0.0722 * (static_cast<double>(pixel[2]) - first);
}

} // namespace io
} // namespace osgVolumizer
