#pragma once

#include "VolumeInstance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// Appends the bricks that can show something: inside geometry and view, and not transparent
/// throughout under the table. Reads no brick that cannot.
void selectBricks(VolumeInstance& volume, const Voxels& voxels, const TableTexture& table,
                  osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
