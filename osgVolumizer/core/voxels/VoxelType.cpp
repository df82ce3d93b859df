#include "VoxelType.h"

#include <limits>

namespace osgVolumizer {

namespace {

struct TypeTraits
{
    const char* name;
    std::size_t size;
    double minimum, maximum;
};

// In the order of VoxelType.
const TypeTraits traits[] = {
    {"int8", 1, -128.0, 127.0},
    {"uint8", 1, 0.0, 255.0},
    {"int16", 2, -32768.0, 32767.0},
    {"uint16", 2, 0.0, 65535.0},
    {"int32", 4, -2147483648.0, 2147483647.0},
    {"uint32", 4, 0.0, 4294967295.0},
    {"half", 2, 0.0, 1.0},
    {"float32", 4, 0.0, 1.0},
    {"float64", 8, 0.0, 1.0},
};
constexpr int TYPE_COUNT = static_cast<int>(sizeof(traits) / sizeof(traits[0]));

/// A number that is no VoxelType, cast from a broken file perhaps, is taken as UINT8.
const TypeTraits& traitsOf(VoxelType type)
{
    const int i = static_cast<int>(type);
    return traits[i >= 0 && i < TYPE_COUNT ? i : static_cast<int>(VoxelType::UINT8)];
}

} // namespace

std::size_t voxelTypeSize(VoxelType type)
{
    return traitsOf(type).size;
}

const char* voxelTypeName(VoxelType type)
{
    return traitsOf(type).name;
}

Result<VoxelType> voxelTypeFromName(const std::string& name)
{
    for (int i = 0; i < TYPE_COUNT; ++i)
        if (name == traits[i].name) return static_cast<VoxelType>(i);
    return Status(ErrorCode::VALUE_INVALID,
                  "voxel type \"" + name +
                      "\" is none of int8, uint8, int16, uint16, int32, uint32, half, float32, "
                      "float64");
}

void voxelTypeRange(VoxelType type, double& minimum, double& maximum)
{
    minimum = traitsOf(type).minimum;
    maximum = traitsOf(type).maximum;
}

} // namespace osgVolumizer
