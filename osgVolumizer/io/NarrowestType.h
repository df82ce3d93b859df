#pragma once

#include "../core/voxels/VoxelData.h"

namespace osgVolumizer {
namespace io {

/// The narrowest integer type that holds whole numbers of a range, unsigned before signed ones of
/// its width; of an empty range UINT8; `otherwise` where there is none.
inline VoxelType narrowestInteger(const core::ValueRange& range, VoxelType otherwise)
{
    for (const VoxelType type : {VoxelType::UINT8, VoxelType::INT8, VoxelType::UINT16,
                                 VoxelType::INT16, VoxelType::UINT32, VoxelType::INT32}) {
        double low = 0.0, high = 0.0;
        voxelTypeRange(type, low, high);
        if (range.low >= low && range.high <= high) return type;
    }
    return otherwise;
}

} // namespace io
} // namespace osgVolumizer
