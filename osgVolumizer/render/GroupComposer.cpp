#include "GroupComposer.h"

#include "../Error.h"
#include "Matrices.h"

#include <osgUtil/StateGraph>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double INFINITE_DEPTH = std::numeric_limits<double>::infinity();

double middle(const core::DepthInterval& d) { return 0.5 * (d.nearDepth + d.farDepth); }

// Any order that does not depend on the order of nodes.
bool comesFirst(const VolumeInstance* a, const VolumeInstance* b)
{
    if (a->depth.farDepth != b->depth.farDepth) return a->depth.farDepth > b->depth.farDepth;
    if (a->depth.nearDepth != b->depth.nearDepth) return a->depth.nearDepth > b->depth.nearDepth;
    const osg::Matrixd &m = *a->frameToEye, &n = *b->frameToEye;
    return std::lexicographical_compare(m.ptr(), m.ptr() + 16, n.ptr(), n.ptr() + 16);
}

} // namespace

bool GroupComposer::prepare(VolumeInstance& instance, PreparedVolume& volume)
{
    volume.instance = &instance;
    volume.view = {toGlm(*instance.leaf->_modelview), toGlm(*instance.leaf->_projection)};
    if (instance.look->features.slab) return true;
    const bool alone = _group.volumes.size() == 1 && _group.surfaces.empty();
    volume.sliced.reset(new SlicedVolume);
    const Status status = volume.sliced->polygonize(instance, volume.view, !alone);
    ++_counts.polygonizations;
    if (!status) reportError(status);
    return status.ok();
}

void GroupComposer::makeLooks(PreparedVolume& volume, double step)
{
    auto look = std::make_shared<VolumeLook>(*volume.instance->look);
    if (volume.sliced) {
        look->step = volume.sliced->spacing();
        look->surfaceNormal = volume.sliced->surfaceNormal();
        look->features.spherical = volume.sliced->spherical();
    } else if (_group.volumes.size() > 1 || !_group.surfaces.empty()) {
        // One lattice of depths for all.
        look->step = step;
        look->latticeOffset = -std::fmod(look->referenceDepth, step);
    }
    volume.looks[WHOLE] = look;
    for (const Part part : {BEHIND_LAYER, IN_FRONT_OF_LAYER}) {
        auto split = std::make_shared<VolumeLook>(*look);
        split->features.layerDepth = true;
        split->inFrontOfLayer = part == IN_FRONT_OF_LAYER;
        volume.looks[part] = split;
    }
}

std::vector<core::ScheduledInterval> GroupComposer::schedule() const
{
    std::vector<core::ScheduleMember> members;
    core::ScheduleLimits limits;
    for (const PreparedVolume& volume : _volumes) {
        members.push_back({volume.instance->depth, true, volume.looks[WHOLE]->step});
        // A slice has no inside that a layer could split.
        if (volume.sliced) limits.surfaceSteps = 1.0;
    }
    for (const ForeignLeaf* surface : _group.surfaces)
        members.push_back({surface->view().depth, false, 0.0});
    return core::depthSchedule(members, limits);
}

void GroupComposer::findEnds(const std::vector<core::ScheduledInterval>& intervals)
{
    _surfaceEnds.assign(_group.surfaces.size(), {INFINITE_DEPTH, -INFINITE_DEPTH});
    const int volumes = static_cast<int>(_volumes.size());
    for (const core::ScheduledInterval& interval : intervals) {
        for (int s : interval.surfaces) {
            core::DepthInterval& ends = _surfaceEnds[static_cast<std::size_t>(s - volumes)];
            ends.nearDepth = std::min(ends.nearDepth, interval.depth.nearDepth);
            ends.farDepth = std::max(ends.farDepth, interval.depth.farDepth);
        }
    }
}

void GroupComposer::compose(std::vector<OrderedLeaf>& leaves)
{
    std::vector<VolumeInstance*> instances = _group.volumes;
    std::sort(instances.begin(), instances.end(), comesFirst);
    double step = INFINITE_DEPTH;
    for (VolumeInstance* instance : instances) {
        PreparedVolume volume;
        if (!prepare(*instance, volume)) continue;
        step = std::min(step, volume.sliced ? volume.sliced->spacing() : instance->look->step);
        _volumes.push_back(std::move(volume));
    }
    for (PreparedVolume& volume : _volumes) makeLooks(volume, step);

    if (_volumes.size() == 1 && _group.surfaces.empty()) {
        PreparedVolume& volume = _volumes.front();
        addVolume(volume, meshOf(volume, {volume.instance->depth}), WHOLE,
                  volume.instance->look->referenceDepth, leaves);
        return;
    }
    const std::vector<core::ScheduledInterval> intervals = schedule();
    findEnds(intervals);
    _counts.intervals += static_cast<double>(intervals.size());
    bool reversed = false;
    for (const core::ScheduledInterval& interval : intervals) {
        std::vector<int> order = interval.volumes;
        if (reversed) std::reverse(order.begin(), order.end());
        reversed = !reversed;
        if (interval.surfaces.empty()) {
            for (int v : order) {
                if (_pendingVolume != v) flush(leaves);
                _pendingVolume = v;
                _volumes[static_cast<std::size_t>(v)].pending.push_back(interval.depth);
            }
            continue;
        }
        flush(leaves);
        composeMixed(interval, order, leaves);
    }
    flush(leaves);
}

void GroupComposer::composeMixed(const core::ScheduledInterval& interval,
                                 const std::vector<int>& order, std::vector<OrderedLeaf>& leaves)
{
    const double depth = middle(interval.depth);
    std::vector<std::shared_ptr<const VolumeMesh>> meshes;
    bool split = false;
    for (int v : order) {
        PreparedVolume& volume = _volumes[static_cast<std::size_t>(v)];
        meshes.push_back(meshOf(volume, {interval.depth}));
        split = split || (!volume.sliced && !meshes.back()->batches.empty());
    }
    if (split) {
        addStep(AccumulationLeaf::BEGIN_LAYER, depth, leaves);
        addPieces(interval, true, leaves);
        addStep(AccumulationLeaf::END_LAYER, depth, leaves);
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
        PreparedVolume& volume = _volumes[static_cast<std::size_t>(order[i])];
        addVolume(volume, meshes[i], volume.sliced ? WHOLE : BEHIND_LAYER, depth, leaves);
    }
    addPieces(interval, false, leaves);
    for (std::size_t i = order.size(); i-- > 0;) {
        PreparedVolume& volume = _volumes[static_cast<std::size_t>(order[i])];
        if (!volume.sliced) addVolume(volume, meshes[i], IN_FRONT_OF_LAYER, depth, leaves);
    }
}

void GroupComposer::flush(std::vector<OrderedLeaf>& leaves)
{
    if (_pendingVolume < 0) return;
    PreparedVolume& volume = _volumes[static_cast<std::size_t>(_pendingVolume)];
    const double depth = middle(volume.pending.front());
    addVolume(volume, meshOf(volume, volume.pending), WHOLE, depth, leaves);
    volume.pending.clear();
    _pendingVolume = -1;
}

std::shared_ptr<const VolumeMesh>
GroupComposer::meshOf(const PreparedVolume& volume,
                      const std::vector<core::DepthInterval>& intervals)
{
    if (!volume.sliced) return slabMesh(*volume.instance, volume.view, intervals);
    if (_group.volumes.size() == 1 && _group.surfaces.empty())
        return volume.sliced->mesh(*volume.instance);
    return volume.sliced->mesh(*volume.instance,
                               {intervals.back().nearDepth, intervals.front().farDepth});
}

void GroupComposer::addVolume(PreparedVolume& volume, std::shared_ptr<const VolumeMesh> mesh,
                              Part part, double depth, std::vector<OrderedLeaf>& leaves)
{
    if (mesh->batches.empty()) return;
    VolumeInstance& instance = *volume.instance;
    const std::shared_ptr<const VolumeLook>& look = volume.looks[part];
    _counts.faces += mesh->faceCount;
    _counts.polygons += static_cast<double>(mesh->indices.size() / 3);
    ++_counts.volumeLeaves;
    osg::ref_ptr<VolumeDrawable> drawable = new VolumeDrawable;
    drawable->set(std::move(mesh), look);
    osg::ref_ptr<osgUtil::RenderLeaf> leaf =
        new osgUtil::RenderLeaf(drawable, instance.leaf->_projection, instance.leaf->_modelview,
                                static_cast<float>(depth));
    osgUtil::StateGraph* graph = instance.leaf->_parent;
    if (look->features.key() != instance.look->features.key())
        graph = graph->_parent->find_or_insert(volumeStateSet(look->features));
    graph->addLeaf(leaf);
    leaves.push_back({depth, leaf.get()});
}

void GroupComposer::addPieces(const core::ScheduledInterval& interval, bool layer,
                              std::vector<OrderedLeaf>& leaves)
{
    const int volumes = static_cast<int>(_volumes.size());
    for (int s : interval.surfaces) {
        const auto index = static_cast<std::size_t>(s - volumes);
        // The outermost pieces reach as far as the leaf's own planes: bounds may be too tight.
        core::DepthInterval depth = interval.depth;
        if (depth.nearDepth == _surfaceEnds[index].nearDepth) depth.nearDepth = -INFINITE_DEPTH;
        if (depth.farDepth == _surfaceEnds[index].farDepth) depth.farDepth = INFINITE_DEPTH;
        osgUtil::RenderLeaf* leaf = _group.surfaces[index]->piece(depth, layer);
        if (!leaf) continue;
        leaves.push_back({middle(interval.depth), leaf});
        ++_counts.surfacePieces;
    }
}

void GroupComposer::addStep(AccumulationLeaf::Step step, double depth,
                            std::vector<OrderedLeaf>& leaves)
{
    leaves.push_back(
        {depth, accumulationLeaf(_accumulation, step, *_volumes.front().instance->leaf)});
}

} // namespace render
} // namespace osgVolumizer
