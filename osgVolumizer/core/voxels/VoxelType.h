#pragma once

#include "../Export.h"
#include "../Status.h"

#include <cstddef>
#include <string>

namespace osgVolumizer {

/// Type of one component of a voxel. Values are calibrated data: an INT16 of -1000 means -1000.
enum class VoxelType : int
{
    INT8,
    UINT8,
    INT16,
    UINT16,
    INT32,
    UINT32,
    HALF,
    FLOAT32,
    FLOAT64
};

/// Bytes of one component.
OSGVOLUMIZER_CORE_EXPORT std::size_t voxelTypeSize(VoxelType type);
/// "uint8", "float32"...
OSGVOLUMIZER_CORE_EXPORT const char* voxelTypeName(VoxelType type);
/// Inverse of voxelTypeName; VALUE_INVALID for any other name.
OSGVOLUMIZER_CORE_EXPORT Result<VoxelType> voxelTypeFromName(const std::string& name);
/// Lowest and highest value an integer type can hold; 0 and 1 for floating point.
OSGVOLUMIZER_CORE_EXPORT void voxelTypeRange(VoxelType type, double& minimum, double& maximum);

} // namespace osgVolumizer
