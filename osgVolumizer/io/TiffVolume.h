#pragma once

#include "PageLayout.h"
#include "VoxelFiles.h"

#include <optional>
#include <string>

namespace osgVolumizer {
namespace io {

// What OpenImageIO does not read of TIFF, where libtiff was found; NOT_SUPPORTED where not.

/// A TIFF whose pages have depth (SGI's tag ImageDepth), in tiles: its first page, one channel. Or
/// one of pages of one bit, in strips: 0 and 1 as they are stored.
Result<Source> readByLibtiff(const std::string& path, std::optional<int> channel);

/// A TIFF of ImageJ of more than 4 GB: all pages lie one behind the other where the only directory
/// says that the first is. Read as it is asked for.
Result<Source> readSinglePage(const std::string& path, const PageLayout& layout, int channel);

} // namespace io
} // namespace osgVolumizer
