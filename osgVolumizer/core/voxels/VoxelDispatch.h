#pragma once

#include "Half.h"
#include "VoxelType.h"

#include <cstdint>

namespace osgVolumizer {
namespace core {

/// Calls `function` with a value of the C++ type of `type`, so that its body is compiled per type.
template <class Function>
auto visitVoxelType(VoxelType type, Function&& function)
{
    switch (type) {
    case VoxelType::INT8:
        return function(std::int8_t());
    case VoxelType::INT16:
        return function(std::int16_t());
    case VoxelType::UINT16:
        return function(std::uint16_t());
    case VoxelType::INT32:
        return function(std::int32_t());
    case VoxelType::UINT32:
        return function(std::uint32_t());
    case VoxelType::HALF:
        return function(Half());
    case VoxelType::FLOAT32:
        return function(float());
    case VoxelType::FLOAT64:
        return function(double());
    case VoxelType::UINT8:
        break;
    }
    return function(std::uint8_t());
}

} // namespace core
} // namespace osgVolumizer
