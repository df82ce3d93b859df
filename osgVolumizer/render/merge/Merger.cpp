#include "Merger.h"

#include "../context/LeafState.h"
#include "../context/Matrices.h"
#include "../context/Statistics.h"
#include "ApplyPaint.h"
#include "MergeGroups.h"
#include "ScreenAreas.h"

#include "../../core/ordering/BrickOrder.h"
#include "../../core/sampling/ViewHelpers.h"

#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <unordered_set>

namespace osgVolumizer {
namespace render {

namespace {

// Depth range of the volume between the near and the far plane; false where nothing is.
bool findDepthRange(VolumeInstance& volume, const core::View& view)
{
    const glm::dmat4& p = view.projection;
    // The near plane is where clip z = -clip w.
    const double a = p[2][2] + p[2][3], b = p[3][2] + p[3][3];
    const double nearPlane = a != 0.0 ? b / a : 0.0;
    // The far plane is where clip z = clip w; projections without one put it nowhere in front.
    const double c = p[2][2] - p[2][3], d = p[3][2] - p[3][3];
    const double farPlane =
        c != 0.0 && d / c > nearPlane ? d / c : std::numeric_limits<double>::infinity();
    const auto expand = [&view](core::DepthInterval& range, const core::Box3d& box) {
        for (int i = 0; i < 8; ++i) {
            const double depth = -(view.toEye * glm::dvec4(box.corner(i), 1.0)).z;
            range.nearDepth = std::min(range.nearDepth, depth);
            range.farDepth = std::max(range.farDepth, depth);
        }
    };
    const auto between = [nearPlane, farPlane](const core::DepthInterval& range) {
        return core::DepthInterval{std::max(range.nearDepth, nearPlane),
                                   std::min(range.farDepth, farPlane)};
    };
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    core::DepthInterval shown{INFINITE, -INFINITE}, whole{INFINITE, -INFINITE};
    for (const SelectedBrick& brick : volume.bricks)
        expand(shown, brick.box);
    if (volume.bricks.empty()) expand(shown, volume.prepared->bounds);
    expand(whole, volume.prepared->regionBox);
    volume.depth = between(shown);
    volume.wholeDepth = between(whole);
    return volume.depth.nearDepth < volume.depth.farDepth;
}

// Puts the bricks in visibility order, far to near.
void sortBricks(VolumeInstance& volume, const core::View& view)
{
    if (volume.bricks.size() < 2 || !volume.prepared->voxelFrame) return;
    const Result<glm::dvec4> eye = core::eyePosition(view);
    if (!eye) return;
    std::vector<std::int64_t> order;
    std::map<std::int64_t, SelectedBrick> byIndex;
    for (SelectedBrick& brick : volume.bricks) {
        order.push_back(brick.index);
        byIndex.emplace(brick.index, std::move(brick));
    }
    core::BrickOrder(volume.appearance->getVoxels()->getLayout()).sort(*eye, order);
    volume.bricks.clear();
    for (std::int64_t index : order)
        volume.bricks.push_back(std::move(byIndex.at(index)));
}

bool isNearer(const OrderedLeaf& a, const OrderedLeaf& b)
{
    return a.depth < b.depth;
}

// The depths between which our leaves, one at least, are drawn.
core::DepthInterval endsOf(const std::vector<OrderedLeaf>& made)
{
    const auto ends = std::minmax_element(made.begin(), made.end(), isNearer);
    return {ends.first->depth, ends.second->depth};
}

// The first and the last of our leaves, around all others.
void addAccumulation(Accumulation& accumulation, const osgUtil::RenderLeaf& beside,
                     const glm::ivec4& viewport, const core::DepthInterval& ends,
                     std::vector<OrderedLeaf>& made)
{
    made.insert(
        made.begin(),
        {ends.farDepth, accumulationLeaf(accumulation, AccumulationLeaf::BEGIN, beside, viewport)});
    made.push_back(
        {ends.nearDepth, accumulationLeaf(accumulation, AccumulationLeaf::END, beside, viewport)});
}

// Tells lit volumes of the stage's lights.
void light(const std::vector<VolumeInstance*>& volumes, osgUtil::RenderBin& bin)
{
    for (VolumeInstance* volume : volumes) {
        if (!volume->look->features.shading || !bin.getStage()) continue;
        auto look = std::make_shared<VolumeLook>(*volume->look);
        look->lights = lightsOf(*bin.getStage());
        volume->look = std::move(look);
    }
}

bool sortsByDepth(const osgUtil::RenderBin* bin)
{
    return bin && bin->getSortMode() == osgUtil::RenderBin::SORT_BACK_TO_FRONT &&
           !const_cast<osgUtil::RenderBin*>(bin)->getDrawCallback() &&
           !dynamic_cast<const osgUtil::RenderStage*>(bin);
}

// A bin and those nested in it that are one with it.
void collectBins(osgUtil::RenderBin& bin, std::vector<osgUtil::RenderBin*>& bins)
{
    bins.push_back(&bin);
    for (const auto& nested : bin.getRenderBinList())
        if (sortsByDepth(nested.second)) collectBins(*nested.second, bins);
}

// Whether something holds of any leaf that is drawn between the ends, or replaced.
template <class Predicate>
bool anyBetween(const std::vector<osgUtil::RenderLeaf*>& leaves,
                const std::unordered_set<const osgUtil::RenderLeaf*>& replaced,
                const core::DepthInterval& ends, Predicate holds)
{
    return std::any_of(leaves.begin(), leaves.end(), [&](const osgUtil::RenderLeaf* leaf) {
        const bool between = leaf->_depth >= ends.nearDepth && leaf->_depth <= ends.farDepth;
        return (between || replaced.count(leaf)) && holds(*leaf);
    });
}

// Tells accumulation what leaves between its ends need of the framebuffer: stencil values; and,
// where they are not ours, what they leave in the depth buffer, and fixed-point values for logic.
void tellNeeds(const std::vector<osgUtil::RenderLeaf*>& leaves,
               const std::unordered_set<const osgUtil::RenderLeaf*>& replaced,
               const core::DepthInterval& ends, Accumulation& accumulation)
{
    const auto isForeign = [](const osgUtil::RenderLeaf& leaf) {
        return !dynamic_cast<const VolumeDrawable*>(leaf.getDrawable());
    };
    if (anyBetween(leaves, replaced, ends, [&](const osgUtil::RenderLeaf& leaf) {
            return isForeign(leaf) && writesDepth(leaf._parent);
        }))
        accumulation.keepDepth();
    if (anyBetween(leaves, replaced, ends, [](const osgUtil::RenderLeaf& leaf) {
            return isOn(leaf._parent, GL_STENCIL_TEST, false);
        }))
        accumulation.useStencil();
    if (anyBetween(leaves, replaced, ends, [&](const osgUtil::RenderLeaf& leaf) {
            return isForeign(leaf) && isOn(leaf._parent, GL_COLOR_LOGIC_OP, false);
        }))
        accumulation.keepFramebuffer();
}

bool mayWriteDepth(const osgUtil::RenderLeaf* leaf)
{
    return writesDepth(leaf->_parent) || !keepsState(*leaf->getDrawable());
}

bool anyWritesDepth(const osgUtil::RenderBin& bin)
{
    auto& b = const_cast<osgUtil::RenderBin&>(bin);
    const auto& leaves = b.getRenderLeafList();
    const auto& graphs = b.getStateGraphList();
    return b.getDrawCallback() || std::any_of(leaves.begin(), leaves.end(), mayWriteDepth) ||
           std::any_of(graphs.begin(), graphs.end(), [](const osgUtil::StateGraph* graph) {
               return std::any_of(graph->_leaves.begin(), graph->_leaves.end(),
                                  [](const auto& leaf) { return mayWriteDepth(leaf.get()); });
           });
}

// What is drawn from a bin before `end` is: whether it finds the bin, and whether depth was
// written.
struct DrawnBefore
{
    bool found = false, depthWritten = false;
};

void visitInDrawOrder(const osgUtil::RenderBin& bin, const osgUtil::RenderBin& end,
                      DrawnBefore& drawn)
{
    const auto& nested = const_cast<osgUtil::RenderBin&>(bin).getRenderBinList();
    for (auto i = nested.begin(); i != nested.end() && i->first < 0 && !drawn.found; ++i)
        visitInDrawOrder(*i->second, end, drawn);
    drawn.found = drawn.found || &bin == &end;
    if (drawn.found) return;
    drawn.depthWritten = drawn.depthWritten || anyWritesDepth(bin);
    for (auto i = nested.lower_bound(0); i != nested.end() && !drawn.found; ++i)
        visitInDrawOrder(*i->second, end, drawn);
}

// Whether the depth buffer is known to hold nothing but 1 when the bin's own leaves come.
bool isDepthClearedBefore(const osgUtil::RenderBin& bin)
{
    const auto* stage = const_cast<osgUtil::RenderBin&>(bin).getStage();
    if (!stage || !(stage->getClearMask() & GL_DEPTH_BUFFER_BIT) || stage->getClearDepth() != 1.0)
        return false;
    DrawnBefore drawn;
    visitInDrawOrder(*stage, bin, drawn);
    return drawn.found && !drawn.depthWritten;
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
    if (const osg::State* state = visitor.getState()) merger->_contextId = state->getContextID();
    bin.setSortCallback(merger);
    return merger;
}

void Merger::sortImplementation(osgUtil::RenderBin* bin)
{
    if (_chained)
        _chained->sortImplementation(bin);
    else
        bin->sortImplementation();
    std::vector<osgUtil::RenderBin*> bins;
    collectBins(*bin, bins);
    for (osgUtil::RenderBin* nested : bins)
        if (nested->getRenderLeafList().empty()) nested->sortBackToFront();
    const std::vector<VolumeInstance*> visible = visibleVolumes(bins);
    light(visible, *bin);
    FrameCounts counts;
    if (!visible.empty()) {
        LeafList& leaves = bin->getRenderLeafList();
        for (std::size_t i = 1; i < bins.size(); ++i) {
            LeafList& nested = bins[i]->getRenderLeafList();
            leaves.insert(leaves.end(), nested.begin(), nested.end());
            nested.clear();
        }
        merge(*bin, leaves, visible, counts);
    }
    report(counts);
}

void Merger::merge(const osgUtil::RenderBin& bin, LeafList& leaves,
                   const std::vector<VolumeInstance*>& visible, FrameCounts& counts)
{
    std::vector<VolumeInstance*> merged = visible;
    applyPaint(merged);
    // Gathered rays are one layer, which nothing can be merged into.
    const auto gathering =
        std::stable_partition(merged.begin(), merged.end(), [](const VolumeInstance* volume) {
            return !volume->look->features.gathers();
        });
    const std::vector<VolumeInstance*> layers(gathering, merged.end());
    merged.erase(gathering, merged.end());
    MergeGroups groups = findMergeGroups(merged, leaves);
    for (VolumeInstance* volume : layers)
        groups.groups.push_back({{volume}, {}});

    std::unordered_set<const osgUtil::RenderLeaf*> replaced;
    for (const VolumeInstance* volume : visible)
        replaced.insert(volume->leaf);
    for (const MergeGroup& group : groups.groups)
        for (const ForeignLeaf* surface : group.surfaces)
            replaced.insert(&surface->leaf());

    const osg::ref_ptr<Accumulation> accumulation = makeAccumulation();
    std::vector<OrderedLeaf> made;
    for (const MergeGroup& group : groups.groups)
        GroupComposer(group, viewport(), _contextId, *accumulation, counts).compose(made);
    for (const VolumeInstance* volume : visible)
        for (const SelectedBrick& brick : volume->bricks)
            counts.bricksDrawn += brick.brickCount;
    if (!made.empty()) {
        const core::DepthInterval ends = endsOf(made);
        tellNeeds(leaves, replaced, ends, *accumulation);
        if (groups.surfaces.empty()) leaveOut(bin, leaves, visible, ends, *accumulation);
        addAccumulation(*accumulation, *visible.front()->leaf, viewport(), ends, made);
    }

    std::vector<OrderedLeaf> all;
    for (osgUtil::RenderLeaf* leaf : leaves)
        if (!replaced.count(leaf)) all.push_back({leaf->_depth, leaf});
    all.insert(all.end(), made.begin(), made.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const OrderedLeaf& a, const OrderedLeaf& b) { return a.depth > b.depth; });
    leaves.clear();
    for (const OrderedLeaf& leaf : all)
        leaves.push_back(leaf.leaf);
}

// What need not be copied where volumes are drawn by themselves.
void Merger::leaveOut(const osgUtil::RenderBin& bin, const LeafList& leaves,
                      const std::vector<VolumeInstance*>& visible, const core::DepthInterval& ends,
                      Accumulation& accumulation) const
{
    bool alone = true, cleared = isDepthClearedBefore(bin);
    for (const osgUtil::RenderLeaf* leaf : leaves) {
        if (dynamic_cast<const VolumeDrawable*>(leaf->getDrawable())) continue;
        alone = alone && !(leaf->_depth >= ends.nearDepth && leaf->_depth <= ends.farDepth);
        cleared = cleared && (leaf->_depth < ends.nearDepth || !mayWriteDepth(leaf));
    }
    if (alone && cleared) accumulation.expectClearedDepth();
    if (!alone || !_oneViewport) return;
    ScreenRectangle screen = viewOf(*visible.front()).screen;
    for (const VolumeInstance* volume : visible) {
        const ScreenRectangle other = viewOf(*volume).screen;
        screen.min = glm::min(screen.min, other.min);
        screen.max = glm::max(screen.max, other.max);
    }
    accumulation.restrictTo(pixelRectangle(screen, viewport(), 4));
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
        VolumeInstance& volume = *found->second;
        const core::View view{toGlm(*leaf->_modelview), toGlm(usualProjection(*leaf))};
        if (!findDepthRange(volume, view)) return true;
        volume.leaf = leaf;
        sortBricks(volume, view);
        result.push_back(&volume);
        return false;
    };
    for (osgUtil::RenderBin* bin : bins) {
        LeafList& leaves = bin->getRenderLeafList();
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
