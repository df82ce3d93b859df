#pragma once

#include "../MergedGroup.h"
#include "RankLeaf.h"

#include <optional>

namespace osgVolumizer {
namespace render {

/// Merges surfaces with volumes by sorting their fragments: see RankLeaf. Exact with any blend
/// function, for any number of volumes in slabs. Every surface is drawn twice per rank: worth it
/// until triangles cost more than intervals do.
class RankedSurfaces
{
public:
    /// Nothing where a region cannot be merged so, or not fast enough.
    static std::optional<RankedSurfaces> of(const MergedGroup& group, const MergeRegion& region);
    void compose(LeafList& leaves) const;

private:
    RankedSurfaces(const MergedGroup& group, const MergeRegion& region)
        : _group(group), _region(region)
    {
    }
    void addStep(RankLeaf::Step step, int index, LeafList& leaves) const;
    void addSurfaces(RankLeaf::Step step, int index, LeafList& leaves) const;
    void addSegment(const std::vector<core::ScheduledInterval>& intervals, int rank,
                    LeafList& leaves) const;

    const MergedGroup& _group;
    const MergeRegion& _region;
};

} // namespace render
} // namespace osgVolumizer
