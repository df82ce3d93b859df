#pragma once

#include "Accumulation.h"
#include "ForeignLeaf.h"
#include "MeshBuilder.h"

#include <osgUtil/RenderLeaf>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// A leaf and the depth that it is sorted by.
struct OrderedLeaf
{
    double depth = 0.0;
    osgUtil::RenderLeaf* leaf = nullptr;
};

/// What a frame did, for the statistics.
struct FrameCounts
{
    double faces = 0.0, polygons = 0.0, polygonizations = 0.0, bricksDrawn = 0.0;
    double volumeLeaves = 0.0, surfacePieces = 0.0, intervals = 0.0;
};

/// Volumes and translucent leaves that overlap in depth and on the screen, directly or through each other.
struct MergeGroup
{
    std::vector<VolumeInstance*> volumes;
    std::vector<const ForeignLeaf*> surfaces;
};

/// Makes the leaves of one group, far to near.
///
/// A volume by itself is one leaf. Where surfaces are in it the interval is drawn as: the surfaces' nearest
/// depth into a layer buffer, the volume behind that depth, the surfaces, the volume in front of it; this is exact
/// where a pixel has one surface in the interval, and off by the interval's thickness where it has
/// more. Several volumes are drawn in slabs one step thick, alternating who goes first: the error of drawing one
/// slab of A behind one of B, ½ tauA tauB h² (cA - cB), has the other sign in the next slab, so it
/// cancels, and what remains is second order in h and independent of who is A.
class GroupComposer
{
public:
    GroupComposer(const MergeGroup& group, Accumulation& accumulation, FrameCounts& counts)
        : _group(group), _accumulation(accumulation), _counts(counts)
    {
    }
    void compose(std::vector<OrderedLeaf>& leaves);

private:
    enum Part { WHOLE, BEHIND_LAYER, IN_FRONT_OF_LAYER };
    struct PreparedVolume
    {
        VolumeInstance* instance = nullptr;
        core::View view;
        std::unique_ptr<SlicedVolume> sliced; ///< slices only
        std::shared_ptr<const VolumeLook> looks[3];
        std::vector<core::DepthInterval> pending; ///< whole intervals, not yet a leaf
    };

    bool prepare(VolumeInstance& instance, PreparedVolume& volume);
    void makeLooks(PreparedVolume& volume, double step);
    std::vector<core::ScheduledInterval> schedule() const;
    void findEnds(const std::vector<core::ScheduledInterval>& intervals);
    void composeMixed(const core::ScheduledInterval& interval, const std::vector<int>& order,
                      std::vector<OrderedLeaf>& leaves);
    void flush(std::vector<OrderedLeaf>& leaves);
    void addVolume(PreparedVolume& volume, std::shared_ptr<const VolumeMesh> mesh, Part part,
                   double depth, std::vector<OrderedLeaf>& leaves);
    void addPieces(const core::ScheduledInterval& interval, bool layer,
                   std::vector<OrderedLeaf>& leaves);
    void addStep(AccumulationLeaf::Step step, double depth, std::vector<OrderedLeaf>& leaves);
    std::shared_ptr<const VolumeMesh> meshOf(const PreparedVolume& volume,
                                             const std::vector<core::DepthInterval>& intervals);

    const MergeGroup& _group;
    Accumulation& _accumulation;
    FrameCounts& _counts;
    std::vector<PreparedVolume> _volumes;
    std::vector<core::DepthInterval> _surfaceEnds; ///< of the intervals that each surface is drawn in
    int _pendingVolume = -1;
};

} // namespace render
} // namespace osgVolumizer
