#pragma once

#include "../core/Export.h"

#include <cstdint>
#include <istream>

namespace osgVolumizer {
namespace io {

/// The ImageDepth (SGI's tag 32997) of the first directory of a TIFF or BigTIFF: how many slices a
/// page holds. 1 where there is none, or no TIFF. OpenImageIO takes such files for their first
/// slice alone.
OSGVOLUMIZER_EXPORT std::uint64_t tiffImageDepth(std::istream& file);

} // namespace io
} // namespace osgVolumizer
