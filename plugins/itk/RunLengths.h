#pragma once

#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace medical {

/// A frame of DICOM's RLE compression: for each byte of each sample, the highest of the first
/// sample first, a run of bytes of all pixels. Writes samples interleaved, lowest byte first. False
/// where it is damaged. For several samples of several bytes each, which GDCM mixes up.
bool decodeRunLengths(const char* data, std::size_t size, int samples, int bytesPerSample,
                      std::size_t pixels, char* destination);

} // namespace medical
} // namespace osgVolumizer
