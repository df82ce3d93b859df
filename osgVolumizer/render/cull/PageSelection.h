#pragma once

#include "../context/ViewHooks.h"
#include "../volume/VolumeInstance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// selectBricks() for voxels that are paged. Chooses the pages that the view should be drawn from:
/// from the coarsest level downwards, wherever a page's samples are further apart than pixels, as
/// far as there is room for their textures; none that show nothing, are outside the view, or would
/// be finer than pixels. Asks for those that are missing, and appends what there is of them, far to
/// near: of a page that is missing, the nearest coarser one that is there. Reads nothing. Expects
/// the volume's look.
void selectPages(VolumeInstance& volume, const Voxels& voxels, const ViewHooks& hooks,
                 osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
