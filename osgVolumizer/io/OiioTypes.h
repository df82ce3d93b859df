#pragma once

#include "../core/voxels/VoxelType.h"

#include <OpenImageIO/typedesc.h>

namespace osgVolumizer {
namespace io {

/// OpenImageIO's name of a voxel type.
OIIO::TypeDesc typeDescOf(VoxelType type);

} // namespace io
} // namespace osgVolumizer
