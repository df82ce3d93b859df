#pragma once

#include "../volume/VolumeInstance.h"
#include "ForeignLeaf.h"

#include <list>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Volumes and translucent leaves that overlap in depth and on the screen, directly or through each
/// other.
struct MergeGroup
{
    std::vector<VolumeInstance*> volumes;
    std::vector<const ForeignLeaf*> surfaces;
};

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

/// Groups what overlaps, by depth and by screen rectangle.
/// \param leaves all leaves of the bin; those of the volumes are skipped
MergeGroups findMergeGroups(const std::vector<VolumeInstance*>& volumes,
                            const std::vector<osgUtil::RenderLeaf*>& leaves);

} // namespace render
} // namespace osgVolumizer
