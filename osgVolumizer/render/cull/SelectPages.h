#pragma once

#include "../context/ViewHooks.h"
#include "../volume/VolumeInstance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// selectBricks() for voxels that are paged. Chooses the pages that the view should be drawn from
/// (see PageSelection), asks for those that are missing and for what will be wanted next, and
/// appends what there is of them, far to near: of a page that is missing, the nearest coarser one
/// that is there. Reads nothing. Expects the volume's look and state.
void selectPages(VolumeInstance& volume, const Voxels& voxels, const ViewHooks& hooks,
                 osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
