#pragma once

#include "../context/ViewHooks.h"
#include "../volume/VolumeInstance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// Appends the bricks that can show something: inside geometry and view, and not transparent
/// throughout under the table; each cut down to the samples that are not. Reads no brick whose
/// range tells that it shows nothing. Expects the volume's look.
void selectBricks(VolumeInstance& volume, const Voxels& voxels, const ViewHooks& hooks,
                  osgUtil::CullVisitor& visitor);

/// The box, moved to the object frame.
osg::BoundingBox objectBounds(const core::Box3d& box, const glm::dmat4& frameToObject);
/// What decides which values of a volume are shown.
OccupancyQuery occupancyQuery(const VolumeInstance& volume, const Voxels& voxels);

/// Whether a box of the voxel frame lies wholly outside a volume's clip planes, or what a cut
/// leaves.
bool isClipped(const VolumeInstance& volume, const core::Box3d& box);

/// The number of the frame that is culled; 0 where the visitor knows none.
unsigned frameOf(const osgUtil::CullVisitor& visitor);

/// Whether so many cells of the selected bricks are empty that leaping over them pays.
bool isWorthSkipping(const VolumeInstance& volume);

} // namespace render
} // namespace osgVolumizer
