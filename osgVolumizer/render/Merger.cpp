#include "Merger.h"

#include "Matrices.h"
#include "MergeGroups.h"
#include "Statistics.h"

#include "../core/ordering/BrickOrder.h"
#include "../core/sampling/ViewHelpers.h"

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
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const SelectedBrick& brick : volume.bricks) {
        for (int i = 0; i < 8; ++i) {
            const double depth = -(view.toEye * glm::dvec4(brick.box.corner(i), 1.0)).z;
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
    }
    if (volume.bricks.empty()) {
        for (int i = 0; i < 8; ++i) {
            const double depth =
                -(view.toEye * glm::dvec4(volume.prepared->bounds.corner(i), 1.0)).z;
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
    }
    volume.depth = {std::max(nearest, nearPlane), std::min(farthest, farPlane)};
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

// The first and the last of our leaves, around all others.
void addAccumulation(Accumulation& accumulation, const osgUtil::RenderLeaf& beside,
                     const glm::ivec4& viewport, std::vector<OrderedLeaf>& made)
{
    const auto byDepth = [](const OrderedLeaf& a, const OrderedLeaf& b) {
        return a.depth < b.depth;
    };
    const auto ends = std::minmax_element(made.begin(), made.end(), byDepth);
    const double nearest = ends.first->depth, farthest = ends.second->depth;
    made.insert(made.begin(), {farthest, accumulationLeaf(accumulation, AccumulationLeaf::BEGIN,
                                                          beside, viewport)});
    made.push_back(
        {nearest, accumulationLeaf(accumulation, AccumulationLeaf::END, beside, viewport)});
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

} // namespace

Merger* Merger::of(osgUtil::RenderBin& bin, osgUtil::CullVisitor& visitor)
{
    if (auto* merger = dynamic_cast<Merger*>(bin.getSortCallback())) return merger;
    osg::ref_ptr<Merger> merger = new Merger;
    merger->_chained = bin.getSortCallback();
    merger->_camera = visitor.getCurrentCamera();
    merger->_frameStamp = visitor.getFrameStamp();
    merger->_viewport = visitor.getViewport();
    bin.setSortCallback(merger);
    return merger;
}

void Merger::sortImplementation(osgUtil::RenderBin* bin)
{
    if (_chained)
        _chained->sortImplementation(bin);
    else
        bin->sortImplementation();
    if (bin->getRenderLeafList().empty()) bin->sortBackToFront();
    LeafList& leaves = bin->getRenderLeafList();
    const std::vector<VolumeInstance*> visible = visibleVolumes(leaves);
    light(visible, *bin);
    // Gathered rays are one layer, which nothing can be merged into.
    std::vector<VolumeInstance*> merged = visible;
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
    for (const auto& volume : _volumes)
        replaced.insert(volume->leaf);
    for (const MergeGroup& group : groups.groups)
        for (const ForeignLeaf* surface : group.surfaces)
            replaced.insert(&surface->leaf());

    FrameCounts counts;
    const glm::ivec4 viewport(_viewport->x(), _viewport->y(), _viewport->width(),
                              _viewport->height());
    const osg::ref_ptr<Accumulation> accumulation = makeAccumulation();
    std::vector<OrderedLeaf> made;
    for (const MergeGroup& group : groups.groups)
        GroupComposer(group, viewport, *accumulation, counts).compose(made);
    for (const VolumeInstance* volume : visible)
        counts.bricksDrawn += static_cast<double>(volume->bricks.size());
    if (!made.empty()) addAccumulation(*accumulation, *visible.front()->leaf, viewport, made);

    std::vector<OrderedLeaf> all;
    for (osgUtil::RenderLeaf* leaf : leaves)
        if (!replaced.count(leaf)) all.push_back({leaf->_depth, leaf});
    all.insert(all.end(), made.begin(), made.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const OrderedLeaf& a, const OrderedLeaf& b) { return a.depth > b.depth; });
    leaves.clear();
    for (const OrderedLeaf& leaf : all)
        leaves.push_back(leaf.leaf);
    report(counts);
}

std::vector<VolumeInstance*> Merger::visibleVolumes(const LeafList& leaves) const
{
    std::unordered_map<const osg::Drawable*, osgUtil::RenderLeaf*> byDrawable;
    for (osgUtil::RenderLeaf* leaf : leaves)
        byDrawable.emplace(leaf->getDrawable(), leaf);
    std::vector<VolumeInstance*> result;
    for (const auto& volume : _volumes) {
        const auto found = byDrawable.find(volume->drawable.get());
        if (found == byDrawable.end()) continue;
        volume->leaf = found->second;
        const core::View view{toGlm(*volume->leaf->_modelview), toGlm(*volume->leaf->_projection)};
        if (!findDepthRange(*volume, view)) continue;
        sortBricks(*volume, view);
        result.push_back(volume.get());
    }
    return result;
}

osg::ref_ptr<Accumulation> Merger::makeAccumulation() const
{
    AccumulationSettings settings;
    settings.x = static_cast<int>(_viewport->x());
    settings.y = static_cast<int>(_viewport->y());
    settings.width = static_cast<int>(_viewport->width());
    settings.height = static_cast<int>(_viewport->height());
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
