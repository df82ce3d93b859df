#pragma once

#include "../Export.h"
#include "Occupancy.h"
#include "VoxelData.h"

#include <functional>
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

/// Finds ranges again of layers that have any sample of some boxes (voxel frame), as scanLayers()
/// would. Looks only at cells that may have the lowest or the highest value of a layer.
/// \param grid of the brick, with the ranges of the samples as they are now
/// \param brickSamples of the brick, voxel frame
/// \param rangeOf the range of the samples of a box, voxel frame
OSGVOLUMIZER_CORE_EXPORT void rescanLayers(LayerRanges& layers, const CellGrid& grid,
                                           const Box3i& brickSamples,
                                           const std::vector<Box3i>& changed,
                                           const std::function<ValueRange(const Box3i&)>& rangeOf);

} // namespace core
} // namespace osgVolumizer
