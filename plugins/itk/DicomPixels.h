#pragma once

#include "DicomHeader.h"

#include <vector>

namespace osgVolumizer {
namespace medical {

/// The pixels of a DICOM file, decoded by GDCM.
class DicomPixels
{
public:
    /// Refused, with a text that begins with the path: FILE_UNREADABLE (fewer bytes than the header
    /// claims, damaged), NOT_SUPPORTED (compression or form that GDCM does not read).
    Status open(const DicomFile& file);
    /// Calibrated values of a frame, columns * rows of them: of colours their luminance, or the
    /// channel that is asked for. Padding is NaN.
    Status readFrame(const DicomFile& file, const DicomFrame& frame, int channel,
                     std::vector<double>& values) const;

    static constexpr int LUMINANCE = -1; ///< as a channel

private:
    double stored(std::size_t index) const;
    double colour(std::size_t pixel, std::size_t pixelsPerFrame, int channel) const;

    std::vector<char> _bytes;
    int _allocated = 8, _storedBits = 8, _highBit = 7, _samples = 1;
    bool _signed = false, _planar = false, _ybr = false, _float = false;
};

} // namespace medical
} // namespace osgVolumizer
