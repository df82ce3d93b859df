#pragma once

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
class VolumeSlice;

namespace render {

/// What VolumeSlice does under a cull visitor: finds the nearest VolumeAppearance above, selects
/// the bricks that are touched, and adds a leaf that draws the slice from them. Writes no member of
/// any node; safe with several cull threads.
void cullSection(VolumeSlice& slice, osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
