#pragma once

#include "../core/Export.h"
#include "../core/Status.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <istream>
#include <optional>
#include <string>

namespace osgVolumizer {
namespace io {

/// The header of a DICOM file (PS3.10, little endian, not compressed, one sample per pixel), as far
/// as it describes voxels. OpenImageIO opens such files too, but gives signed pixels wrapped around
/// zero, stretches 12 bits to 16, loses the rescale intercept and all frames but the first;
/// calibrated values need the file itself.
struct DicomHeader
{
    glm::ivec3 size{0};    ///< columns, rows, frames
    int bitsAllocated = 0; ///< 8, 16 or 32
    int bitsStored = 0, highBit = 0;
    bool isSigned = false;
    double slope = 1.0, intercept = 0.0; ///< data value = slope * stored + intercept
    std::int64_t pixelOffset = 0;        ///< in the file

    glm::dvec2 pixelSpacing{0.0}; ///< along x and y, mm; 0 where it is not said
    double sliceSpacing =
        0.0; ///< mm between slices or, failing that, their thickness; 0 where unsaid
    std::optional<double> position; ///< mm along the normal of the slice
    /// Directions of columns' index, rows' index and normal in the patient's frame; identity where
    /// unsaid.
    glm::dmat3 axes{1.0};
    std::optional<std::int64_t> instance;
    std::string series; ///< the identifier of the scan that it is part of; empty where unsaid

    std::int64_t pixelBytes() const
    {
        return std::int64_t(size.x) * size.y * size.z * (bitsAllocated / 8); // below 2^63
    }
};

/// True where a stream starts as a DICOM file does.
OSGVOLUMIZER_EXPORT bool isDicom(std::istream& file);
/// Reads everything but the pixels. `name` is for messages. FILE_UNREADABLE (cut short or broken),
/// VALUE_INVALID (an impossible field), SIZE_MISMATCH (pixels), NOT_SUPPORTED (compressed, big
/// endian, colour).
OSGVOLUMIZER_EXPORT Result<DicomHeader> readDicomHeader(std::istream& file,
                                                        const std::string& name);

} // namespace io
} // namespace osgVolumizer
