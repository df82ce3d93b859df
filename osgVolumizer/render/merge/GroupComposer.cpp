#include "GroupComposer.h"

#include "captured/CapturedSurfaces.h"
#include "intervals/IntervalSurfaces.h"
#include "ranked/RankedSurfaces.h"

namespace osgVolumizer {
namespace render {

void composeGroup(const MergeGroup& group, const MergeFrame& frame, LeafList& leaves)
{
    const MergedGroup merged(group, frame, leaves);
    if (merged.volumes().empty()) return;
    for (const MergeRegion& region : merged.regions()) {
        if (const auto captured = CapturedSurfaces::of(merged, region))
            captured->compose(leaves);
        else if (const auto ranked = RankedSurfaces::of(merged, region))
            ranked->compose(leaves);
        else
            IntervalSurfaces(merged, region).compose(leaves);
    }
}

} // namespace render
} // namespace osgVolumizer
