#include "Merger.h"

#include "../Error.h"
#include "Accumulation.h"
#include "Matrices.h"
#include "MeshBuilder.h"
#include "Statistics.h"

#include "../core/ordering/BrickOrder.h"
#include "../core/sampling/ViewHelpers.h"

#include <osg/Depth>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgVolumizer {
namespace render {

namespace {

using LeafList = osgUtil::RenderBin::RenderLeafList;

// Depth range of the volume in front of the near plane; false where nothing is.
bool findDepthRange(VolumeInstance& volume, const core::View& view)
{
    const glm::dmat4& p = view.projection;
    // The near plane is where clip z = -clip w.
    const double a = p[2][2] + p[2][3], b = p[3][2] + p[3][3];
    const double nearPlane = a != 0.0 ? b / a : 0.0;
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
            const double depth = -(view.toEye * glm::dvec4(volume.prepared->bounds.corner(i), 1.0)).z;
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
    }
    volume.nearDepth = std::max(nearest, nearPlane);
    volume.farDepth = farthest;
    return volume.nearDepth < volume.farDepth;
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
    for (std::int64_t index : order) volume.bricks.push_back(std::move(byIndex.at(index)));
}

osg::ref_ptr<osg::StateSet> accumulationStateSet()
{
    static const osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    return set;
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
    findLeaves(leaves);

    for (const auto& volume : _volumes) {
        if (!volume->leaf) continue;
        const core::View view{toGlm(*volume->leaf->_modelview), toGlm(*volume->leaf->_projection)};
        if (!findDepthRange(*volume, view)) continue;
        sortBricks(*volume, view);
        auto look = std::make_shared<VolumeLook>(*volume->look);
        std::shared_ptr<const VolumeMesh> mesh;
        if (look->features.slab) {
            mesh = slabMesh(*volume, view, {{volume->nearDepth, volume->farDepth}});
        } else {
            auto slices = sliceMesh(*volume, view, look->step, look->surfaceNormal);
            if (!slices) {
                reportError(slices.status);
                continue;
            }
            mesh = *slices;
            count(_camera, _frameStamp, "osgVolumizer polygonizations", 1.0);
        }
        count(_camera, _frameStamp, "osgVolumizer faces", mesh->faceCount);
        count(_camera, _frameStamp, "osgVolumizer polygons",
              static_cast<double>(mesh->indices.size() / 3));
        count(_camera, _frameStamp, "osgVolumizer bricks drawn",
              static_cast<double>(volume->bricks.size()));
        volume->drawable->set(std::move(mesh), std::move(look));
    }
    insertAccumulation(leaves);
}

void Merger::findLeaves(const LeafList& leaves)
{
    for (osgUtil::RenderLeaf* leaf : leaves) {
        for (const auto& volume : _volumes)
            if (leaf->getDrawable() == volume->drawable) volume->leaf = leaf;
    }
}

void Merger::insertAccumulation(LeafList& leaves)
{
    const auto isVolume = [](const osgUtil::RenderLeaf* leaf) {
        const auto* drawable = dynamic_cast<const VolumeDrawable*>(leaf->getDrawable());
        return drawable && drawable->mesh();
    };
    const auto first = std::find_if(leaves.begin(), leaves.end(), isVolume);
    if (first == leaves.end()) return;
    const auto last = std::find_if(leaves.rbegin(), leaves.rend(), isVolume).base();
    AccumulationSettings settings;
    settings.x = static_cast<int>(_viewport->x());
    settings.y = static_cast<int>(_viewport->y());
    settings.width = static_cast<int>(_viewport->width());
    settings.height = static_cast<int>(_viewport->height());
    const osg::ref_ptr<Accumulation> accumulation = new Accumulation(settings);
    const auto makeLeaf = [&](const osgUtil::RenderLeaf& beside, AccumulationLeaf::Step step) {
        osg::ref_ptr<osgUtil::RenderLeaf> leaf = new osgUtil::RenderLeaf(
            new AccumulationLeaf(accumulation, step), beside._projection, beside._modelview);
        beside._parent->find_or_insert(accumulationStateSet())->addLeaf(leaf);
        return leaf.get();
    };
    osgUtil::RenderLeaf* begin = makeLeaf(**first, AccumulationLeaf::BEGIN);
    osgUtil::RenderLeaf* end = makeLeaf(**first, AccumulationLeaf::END);
    leaves.insert(last, end);
    leaves.insert(std::find_if(leaves.begin(), leaves.end(), isVolume), begin);
}

} // namespace render
} // namespace osgVolumizer
