#pragma once

#include "Samples.h"

#include <string_view>

namespace osgVolumizer {
namespace medical {

/// What the header of a NIfTI-1, NIfTI-2 or Analyze 7.5 file says.
struct NiftiHeader
{
    static constexpr std::size_t MOST_BYTES = 540;

    Samples samples;         ///< without data
    bool swapped = false;    ///< the other byte order
    bool detached = false;   ///< the numbers are in a file .img
    std::int64_t offset = 0; ///< of the first number

    /// `head` is the beginning of a file, MOST_BYTES or all of it. Where it lies is by the sform if
    /// it has a code above 0 and spans a volume, however skewed; else by the qform; else voxels are
    /// axis-aligned around the origin, x to the left as i grows, as in Analyze. RAS becomes LPS,
    /// metres and micrometres millimetres. A text follows the path: VALUE_INVALID, FILE_UNREADABLE,
    /// NOT_SUPPORTED (numbers, or dimensions, that no volume has).
    static Result<NiftiHeader> parse(std::string_view head);
};

} // namespace medical
} // namespace osgVolumizer
