#include "IntervalSurfaces.h"

#include "../../draw/AccumulationLeaf.h"

#include <algorithm>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double INFINITE_DEPTH = std::numeric_limits<double>::infinity();

} // namespace

IntervalSurfaces::IntervalSurfaces(const MergedGroup& group, const MergeRegion& region)
    : _group(group), _region(region), _intervals(scheduleOf(group, region.surfaces))
{
    for (const MergedVolume& volume : group.volumes()) {
        const bool atOnce = group.volumes().size() == 1 && region.surfaces.empty();
        VolumePart part = group.partIn(region, volume);
        _whole.push_back(
            std::make_shared<const VolumePart>(atOnce ? group.wholeIn(region, volume) : part));
        part.features.splitDepth = true;
        _behind.push_back(std::make_shared<const VolumePart>(part));
        part.inFrontOfSplit = true;
        _inFront.push_back(std::make_shared<const VolumePart>(std::move(part)));
    }
    for (std::size_t i = 0; i < region.surfaces.size(); ++i)
        _pieces.push_back(piecesOf(i));
    group.frame().counts.intervals += static_cast<double>(_intervals.size());
}

IntervalSurfaces::Pieces IntervalSurfaces::piecesOf(std::size_t number) const
{
    Pieces pieces;
    pieces.surface = &_group.surfaces()[_region.surfaces[number]];
    pieces.ends = {INFINITE_DEPTH, -INFINITE_DEPTH};
    const int member = static_cast<int>(_group.volumes().size() + number);
    std::vector<core::DepthInterval> depths;
    for (const core::ScheduledInterval& interval : _intervals) {
        depths.push_back(interval.depth);
        const auto& in = interval.surfaces;
        if (std::find(in.begin(), in.end(), member) == in.end()) continue;
        pieces.ends.nearDepth = std::min(pieces.ends.nearDepth, interval.depth.nearDepth);
        pieces.ends.farDepth = std::max(pieces.ends.farDepth, interval.depth.farDepth);
    }
    if (pieces.surface->mesh) pieces.indices = pieces.surface->mesh->split(depths);
    return pieces;
}

void IntervalSurfaces::compose(LeafList& leaves) const
{
    SlabQueue slabs(_group, _whole, leaves);
    for (std::size_t i = 0; i < _intervals.size(); ++i) {
        if (_intervals[i].surfaces.empty()) {
            slabs.add(_intervals[i].depth, alternatingOrder(_intervals[i], i));
        } else {
            slabs.flush();
            composeMixed(i, leaves);
        }
    }
}

void IntervalSurfaces::composeMixed(std::size_t interval, LeafList& leaves) const
{
    const core::DepthInterval& range = _intervals[interval].depth;
    const double depth = middleOf(range);
    const std::vector<int> order = alternatingOrder(_intervals[interval], interval);
    std::vector<std::shared_ptr<const VolumeMesh>> meshes;
    bool split = false;
    for (int v : order) {
        const MergedVolume& volume = _group.volumes()[static_cast<std::size_t>(v)];
        meshes.push_back(_group.meshOf(volume, {range}));
        split = split || (!volume.sliced && !meshes.back()->batches.empty());
    }
    if (split) addSplit(interval, leaves);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto v = static_cast<std::size_t>(order[i]);
        const MergedVolume& volume = _group.volumes()[v];
        _group.addVolume(volume, meshes[i], volume.sliced ? _whole[v] : _behind[v], depth, leaves);
    }
    addPieces(interval, false, leaves);
    for (std::size_t i = order.size(); i-- > 0;) {
        const auto v = static_cast<std::size_t>(order[i]);
        const MergedVolume& volume = _group.volumes()[v];
        if (!volume.sliced) _group.addVolume(volume, meshes[i], _inFront[v], depth, leaves);
    }
}

// The nearest depth of an interval's surfaces, for the segments of volumes to be split at.
void IntervalSurfaces::addSplit(std::size_t interval, LeafList& leaves) const
{
    const double depth = middleOf(_intervals[interval].depth);
    const osgUtil::RenderLeaf& beside = *_group.volumes().front().instance->leaf;
    const glm::ivec4 area = _group.areaOf(_region);
    Accumulation& accumulation = _group.frame().accumulation;
    leaves.add(depth, accumulationLeaf(accumulation, AccumulationLeaf::BEGIN_SPLIT, beside, area));
    addPieces(interval, true, leaves);
    leaves.add(depth, accumulationLeaf(accumulation, AccumulationLeaf::END_SPLIT, beside, area));
}

void IntervalSurfaces::addPieces(std::size_t interval, bool depthOnly, LeafList& leaves) const
{
    const core::ScheduledInterval& scheduled = _intervals[interval];
    for (int member : scheduled.surfaces) {
        const Pieces& pieces = _pieces[static_cast<std::size_t>(member) - _group.volumes().size()];
        const SurfaceMesh* mesh = pieces.surface->mesh.get();
        osg::ref_ptr<osg::Drawable> part;
        if (mesh) {
            if (pieces.indices[interval]->empty()) continue;
            part = mesh->drawable(pieces.indices[interval]);
        }
        // The outermost pieces reach as far as the leaf's own planes: bounds may be too tight.
        core::DepthInterval depth = scheduled.depth;
        if (depth.nearDepth == pieces.ends.nearDepth) depth.nearDepth = -INFINITE_DEPTH;
        if (depth.farDepth == pieces.ends.farDepth) depth.farDepth = INFINITE_DEPTH;
        osgUtil::RenderLeaf* leaf = pieces.surface->leaf->piece(depth, depthOnly, part);
        if (!leaf) continue;
        leaves.add(middleOf(scheduled.depth), leaf);
        ++_group.frame().counts.surfacePieces;
    }
}

} // namespace render
} // namespace osgVolumizer
