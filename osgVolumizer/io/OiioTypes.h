#pragma once

#include "../core/voxels/VoxelType.h"

#include <OpenImageIO/typedesc.h>

#include <string>

namespace osgVolumizer {
namespace io {

/// OpenImageIO's name of a voxel type.
OIIO::TypeDesc typeDescOf(VoxelType type);

/// A message of OpenImageIO's, whose lines become one.
std::string oneLine(std::string text);

} // namespace io
} // namespace osgVolumizer
