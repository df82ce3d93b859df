#pragma once

#include <osg/BoundingBox>

namespace osg {
class Drawable;
}

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
class VolumeGeometry;

namespace render {

/// What VolumeGeometry does under a cull visitor: finds the nearest VolumeAppearance above, rejects
/// by frustum, reports near and far, selects bricks, and registers the volume with the merger of
/// the current transparent bin. Writes no member of any node; safe with several cull threads.
void cull(VolumeGeometry& geometry, osgUtil::CullVisitor& visitor);

/// What osgUtil::CullVisitor does for every drawable before it looks at it: false if the user's
/// callback or the frustum rejects it.
bool passesOsgCulling(osg::Drawable& drawable, const osg::BoundingBox& bounds,
                      osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
