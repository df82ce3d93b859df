#pragma once

#include "GroupComposer.h"

#include <list>

namespace osgVolumizer {
namespace render {

/// The groups of a bin. Every volume is in one; surfaces only where they overlap one.
struct MergeGroups
{
    std::list<ForeignLeaf> surfaces; ///< that the groups point to
    std::vector<MergeGroup> groups;
};

/// Where a volume is in its view.
BoxInView viewOf(const VolumeInstance& volume);
/// In depth and on the screen.
bool overlaps(const BoxInView& a, const BoxInView& b);

/// Finds who overlaps whom, by depth and by screen rectangle.
/// \param leaves all leaves of the bin; those of the volumes are skipped
MergeGroups findMergeGroups(const std::vector<VolumeInstance*>& volumes,
                            const std::vector<osgUtil::RenderLeaf*>& leaves);

} // namespace render
} // namespace osgVolumizer
