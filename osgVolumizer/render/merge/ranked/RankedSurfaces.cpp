#include "RankedSurfaces.h"

#include "../../context/ContextRefusals.h"
#include "../../context/LeafState.h"
#include "../SlabQueue.h"

namespace osgVolumizer {
namespace render {

namespace {

// What a drawable that is no mesh counts for.
constexpr std::size_t MAXIMUM_TRIANGLES = 20000, UNKNOWN_TRIANGLES = 1000;

// Whether a surface's fragments can be sorted by a state of ours.
bool canBeSorted(const MergedSurface& surface)
{
    // Fragments are counted by stencil values, and the target is of floats, which logic operations
    // leave alone.
    return surface.leavesDepth() && !isOn(surface.graph(), GL_STENCIL_TEST, false) &&
           hasUsualDepthTest(surface.graph()) && !isOn(surface.graph(), GL_COLOR_LOGIC_OP, false);
}

} // namespace

std::optional<RankedSurfaces> RankedSurfaces::of(const MergedGroup& group,
                                                 const MergeRegion& region)
{
    if (region.surfaces.empty()) return std::nullopt;
    if (isRefused(group.frame().contextId, Refusal::RANKED_SURFACES)) return std::nullopt;
    for (const MergedVolume& volume : group.volumes())
        if (volume.sliced) return std::nullopt;
    std::size_t triangles = 0;
    for (std::size_t s : region.surfaces) {
        const MergedSurface& surface = group.surfaces()[s];
        if (!canBeSorted(surface)) return std::nullopt;
        triangles += surface.mesh ? surface.mesh->triangleCount() : UNKNOWN_TRIANGLES;
    }
    if (triangles > MAXIMUM_TRIANGLES) return std::nullopt;
    return RankedSurfaces(group, region);
}

void RankedSurfaces::compose(LeafList& leaves) const
{
    using Step = RankLeaf::Step;
    const std::vector<core::ScheduledInterval> intervals = scheduleOf(_group, {});
    _group.frame().accumulation.requireTarget();
    for (int k = 0; k < RankLeaf::RANK_COUNT; ++k) {
        addStep(Step::BEGIN_DEPTHS, k, leaves);
        addSurfaces(Step::BEGIN_DEPTHS, k, leaves);
        addStep(Step::END_DEPTHS, k, leaves);
    }
    addStep(Step::SORT, 0, leaves);
    for (int rank = 0; rank <= RankLeaf::RANK_COUNT; ++rank) {
        addSegment(intervals, rank, leaves);
        const bool rest = rank == RankLeaf::RANK_COUNT;
        const int query = rest ? rank - 1 : rank;
        const Step begin = rest ? Step::BEGIN_REST : Step::BEGIN_RANK;
        addStep(begin, query, leaves);
        addSurfaces(begin, rank, leaves);
        addStep(rest ? Step::END_REST : Step::END_RANK, query, leaves);
    }
    _group.addDepths(_region.surfaces, leaves);
}

// The volumes behind the surfaces of a rank, and in front of those of the last one.
void RankedSurfaces::addSegment(const std::vector<core::ScheduledInterval>& intervals, int rank,
                                LeafList& leaves) const
{
    SlabQueue::Parts parts;
    for (const MergedVolume& volume : _group.volumes()) {
        VolumePart part = _group.partIn(_region, volume);
        part.features.ranked = true;
        part.rank = rank;
        parts.push_back(std::make_shared<const VolumePart>(std::move(part)));
    }
    LeafList segments;
    {
        SlabQueue slabs(_group, parts, segments);
        for (std::size_t i = 0; i < intervals.size(); ++i)
            slabs.add(intervals[i].depth, alternatingOrder(intervals[i], i));
    }
    addStep(RankLeaf::BEGIN_SEGMENT, rank, leaves);
    // All steps have one depth, which keeps them together.
    for (const LeafList::Entry& segment : segments)
        leaves.add(_group.depth(), segment.leaf);
    addStep(RankLeaf::END_SEGMENT, rank, leaves);
}

void RankedSurfaces::addStep(RankLeaf::Step step, int index, LeafList& leaves) const
{
    _group.addStep(new RankLeaf(&_group.frame().accumulation, step, index, _group.areaOf(_region)),
                   RankLeaf::stateSet(step), _group.depth(), leaves);
}

void RankedSurfaces::addSurfaces(RankLeaf::Step step, int index, LeafList& leaves) const
{
    _group.addCopies(_region.surfaces, *rankedSurfaceState(step, index), _group.depth(), leaves);
}

} // namespace render
} // namespace osgVolumizer
