#include "OiioTypes.h"

#include <algorithm>

namespace osgVolumizer {
namespace io {

OIIO::TypeDesc typeDescOf(VoxelType type)
{
    switch (type) {
    case VoxelType::INT8:
        return OIIO::TypeDesc::INT8;
    case VoxelType::UINT8:
        return OIIO::TypeDesc::UINT8;
    case VoxelType::INT16:
        return OIIO::TypeDesc::INT16;
    case VoxelType::UINT16:
        return OIIO::TypeDesc::UINT16;
    case VoxelType::INT32:
        return OIIO::TypeDesc::INT32;
    case VoxelType::UINT32:
        return OIIO::TypeDesc::UINT32;
    case VoxelType::HALF:
        return OIIO::TypeDesc::HALF;
    case VoxelType::FLOAT32:
        return OIIO::TypeDesc::FLOAT;
    case VoxelType::FLOAT64:
        return OIIO::TypeDesc::DOUBLE;
    }
    return OIIO::TypeDesc::UNKNOWN;
}

std::string oneLine(std::string text)
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

} // namespace io
} // namespace osgVolumizer
