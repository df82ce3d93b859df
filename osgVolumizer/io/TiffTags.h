#pragma once

#include "../core/Export.h"

#include <cstdint>
#include <istream>
#include <optional>

namespace osgVolumizer {
namespace io {

/// What the first directory of a TIFF or BigTIFF says, and OpenImageIO does not. As the standard
/// has it where there is no such tag, or no TIFF.
struct TiffTags
{
    std::uint64_t imageDepth = 1;    ///< slices that a page holds (SGI's tag 32997)
    std::uint64_t bitsPerSample = 8; ///< before they are widened; 1 where there is no such tag
    bool minIsWhite = false;
    std::optional<std::uint64_t> lostPage; ///< the first that is said to lie beyond the file's end

    /// OpenImageIO takes files with depth for their first slice alone.
    static OSGVOLUMIZER_EXPORT TiffTags read(std::istream& file);
};

} // namespace io
} // namespace osgVolumizer
