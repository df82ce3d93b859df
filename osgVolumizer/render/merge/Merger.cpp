#include "Merger.h"

#include "../context/ContextLimits.h"
#include "../context/Statistics.h"
#include "../draw/AccumulationLeaf.h"
#include "AccumulationNeeds.h"
#include "ApplyPaint.h"
#include "BinScan.h"
#include "GroupComposer.h"
#include "LeafList.h"

#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <atomic>
#include <unordered_map>

namespace osgVolumizer {
namespace render {

namespace {

void raise(std::atomic<double>& number, double to)
{
    for (double now = number; to > now && !number.compare_exchange_weak(now, to);) {
    }
}

// Tells lit volumes of the stage's lights.
void light(const std::vector<VolumeInstance*>& volumes, osgUtil::RenderBin& bin)
{
    std::shared_ptr<const std::vector<EyeLight>> lights;
    for (VolumeInstance* volume : volumes) {
        if (!volume->look->features.shading || !bin.getStage()) continue;
        if (!lights)
            lights = std::make_shared<const std::vector<EyeLight>>(lightsOf(*bin.getStage()));
        volume->lights = lights;
        constexpr double MOST = 1000.0;
        if (volume->brightness) raise(*volume->brightness, std::min(brightnessOf(*lights), MOST));
    }
}

// Finds what has to be merged together. What gathers rays is drawn at once, at one depth, which
// nothing can be merged into.
MergeGroups groupsOf(const std::vector<VolumeInstance*>& visible,
                     const std::vector<osgUtil::RenderLeaf*>& leaves)
{
    std::vector<VolumeInstance*> merged = visible;
    applyPaint(merged);
    const auto gathering =
        std::stable_partition(merged.begin(), merged.end(), [](const VolumeInstance* volume) {
            return !volume->look->features.gathers();
        });
    const std::vector<VolumeInstance*> apart(gathering, merged.end());
    merged.erase(gathering, merged.end());
    MergeGroups groups = findMergeGroups(merged, leaves);
    for (VolumeInstance* volume : apart)
        groups.groups.push_back({{volume}, {}});
    return groups;
}

// The leaves of volumes, and of the surfaces that are merged with them.
std::unordered_set<const osgUtil::RenderLeaf*>
replacedLeaves(const std::vector<VolumeInstance*>& visible, const MergeGroups& groups)
{
    std::unordered_set<const osgUtil::RenderLeaf*> replaced;
    for (const VolumeInstance* volume : visible)
        replaced.insert(volume->leaf);
    for (const MergeGroup& group : groups.groups)
        for (const ForeignLeaf* surface : group.surfaces)
            replaced.insert(&surface->leaf());
    return replaced;
}

} // namespace

Merger* Merger::of(osgUtil::RenderBin& innermost, osgUtil::CullVisitor& visitor)
{
    osgUtil::RenderBin* outermost = &innermost;
    while (sortsByDepth(outermost) && sortsByDepth(outermost->getParent()))
        outermost = outermost->getParent();
    osgUtil::RenderBin& bin = *outermost;
    if (auto* merger = dynamic_cast<Merger*>(bin.getSortCallback())) {
        if (*merger->_viewport != *visitor.getViewport()) merger->_oneViewport = false;
        return merger;
    }
    osg::ref_ptr<Merger> merger = new Merger;
    merger->_chained = bin.getSortCallback();
    merger->_camera = visitor.getCurrentCamera();
    merger->_frameStamp = visitor.getFrameStamp();
    merger->_viewport = visitor.getViewport();
    if (const osg::State* state = visitor.getState()) {
        merger->_contextId = state->getContextID();
        merger->_textureUnits = textureUnitsOf(*state);
    }
    bin.setSortCallback(merger);
    return merger;
}

void Merger::sortImplementation(osgUtil::RenderBin* bin)
{
    if (_chained)
        _chained->sortImplementation(bin);
    else
        bin->sortImplementation();
    const std::vector<osgUtil::RenderBin*> bins = binsOf(*bin);
    for (osgUtil::RenderBin* nested : bins)
        if (nested->getRenderLeafList().empty()) nested->sortBackToFront();
    const std::vector<VolumeInstance*> visible = visibleVolumes(bins);
    light(visible, *bin);
    FrameCounts counts;
    if (!visible.empty()) {
        BinLeaves& leaves = bin->getRenderLeafList();
        for (std::size_t i = 1; i < bins.size(); ++i) {
            BinLeaves& nested = bins[i]->getRenderLeafList();
            leaves.insert(leaves.end(), nested.begin(), nested.end());
            nested.clear();
        }
        merge(*bin, leaves, visible, counts);
    }
    report(counts);
}

void Merger::merge(const osgUtil::RenderBin& bin, BinLeaves& leaves,
                   const std::vector<VolumeInstance*>& visible, FrameCounts& counts)
{
    const MergeGroups groups = groupsOf(visible, leaves);
    const auto replaced = replacedLeaves(visible, groups);
    const osg::ref_ptr<Accumulation> accumulation = makeAccumulation();
    LeafList made;
    for (const MergeGroup& group : groups.groups)
        composeGroup(group, {viewport(), _contextId, _textureUnits, *accumulation, counts}, made);
    for (const VolumeInstance* volume : visible)
        for (const SelectedBrick& brick : volume->bricks)
            counts.bricksDrawn += brick.brickCount;
    if (!made.empty()) {
        const AccumulatedLeaves drawn{bin, leaves, replaced, made.ends()};
        const glm::ivec4 area = viewport();
        tellNeeds(drawn, *accumulation);
        if (groups.surfaces.empty())
            tellUnneeded(drawn, visible, _oneViewport ? &area : nullptr, *accumulation);
        const osgUtil::RenderLeaf& beside = *visible.front()->leaf;
        made.enclose(accumulationLeaf(*accumulation, AccumulationLeaf::BEGIN, beside, area),
                     accumulationLeaf(*accumulation, AccumulationLeaf::END, beside, area));
    }
    LeafList all;
    for (osgUtil::RenderLeaf* leaf : leaves)
        if (!replaced.count(leaf)) all.add(leaf->_depth, leaf);
    all.append(made);
    all.sortFarToNear();
    leaves.clear();
    for (const LeafList::Entry& entry : all)
        leaves.push_back(entry.leaf);
    _last = leaves.empty() ? nullptr : leaves.back();
}

glm::ivec4 Merger::viewport() const
{
    return {_viewport->x(), _viewport->y(), _viewport->width(), _viewport->height()};
}

// Also takes the leaves of volumes that are not to be seen out of their bins.
std::vector<VolumeInstance*>
Merger::visibleVolumes(const std::vector<osgUtil::RenderBin*>& bins) const
{
    std::unordered_map<const osg::Drawable*, VolumeInstance*> byDrawable;
    for (const auto& volume : _volumes)
        byDrawable.emplace(volume->drawable.get(), volume.get());
    std::vector<VolumeInstance*> result;
    const auto isHidden = [&](osgUtil::RenderLeaf* leaf) {
        const auto found = byDrawable.find(leaf->getDrawable());
        if (found == byDrawable.end()) return false;
        if (!placeInView(*found->second, *leaf)) return true;
        result.push_back(found->second);
        return false;
    };
    for (osgUtil::RenderBin* bin : bins) {
        BinLeaves& leaves = bin->getRenderLeafList();
        leaves.erase(std::remove_if(leaves.begin(), leaves.end(), isHidden), leaves.end());
    }
    return result;
}

osg::ref_ptr<Accumulation> Merger::makeAccumulation() const
{
    AccumulationSettings settings;
    settings.viewport = viewport();
    settings.bits = 8;
    for (const auto& volume : _volumes)
        settings.bits = std::max(settings.bits, volume->appearance->getAccumulationBits());
    settings.marched = std::any_of(_volumes.begin(), _volumes.end(),
                                   [](const auto& volume) { return volume->look->features.slab; });
    return new Accumulation(settings);
}

void Merger::report(const FrameCounts& counts) const
{
    const std::pair<const char*, double> values[] = {
        {"osgVolumizer faces", counts.faces},
        {"osgVolumizer polygons", counts.polygons},
        {"osgVolumizer polygonizations", counts.polygonizations},
        {"osgVolumizer bricks drawn", counts.bricksDrawn},
        {"osgVolumizer volume leaves", counts.volumeLeaves},
        {"osgVolumizer surface pieces", counts.surfacePieces},
        {"osgVolumizer intervals", counts.intervals}};
    osg::ref_ptr<const osg::Camera> camera;
    if (!_camera.lock(camera)) return;
    for (const auto& value : values)
        count(camera, _frameStamp, value.first, value.second);
}

} // namespace render
} // namespace osgVolumizer
