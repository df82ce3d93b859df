#pragma once

#include "../Export.h"
#include "VoxelData.h"

#include <vector>

namespace osgVolumizer {
namespace core {

/// The ranges of a block's layers of samples, one sample thick, across each axis.
struct LayerRanges
{
    std::vector<ValueRange> axis[3];
};

/// Ranges of one component; values that are not finite do not count. One pass over the data.
OSGVOLUMIZER_CORE_EXPORT LayerRanges scanLayers(const VoxelView& view, int component = 0);

} // namespace core
} // namespace osgVolumizer
