#include "VolumeInstance.h"

#include "../context/LeafState.h"
#include "../context/Matrices.h"

#include "../../core/ordering/BrickOrder.h"
#include "../../core/sampling/ViewHelpers.h"

#include <algorithm>
#include <limits>
#include <map>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double UNBOUNDED_DEPTH = std::numeric_limits<double>::infinity();

// Depths of the near and the far plane: where clip z = -clip w, and clip z = clip w. Projections
// without a far plane put it nowhere in front.
core::DepthInterval clipDepths(const glm::dmat4& p)
{
    const double a = p[2][2] + p[2][3], b = p[3][2] + p[3][3];
    const double nearPlane = a != 0.0 ? b / a : 0.0;
    const double c = p[2][2] - p[2][3], d = p[3][2] - p[3][3];
    return {nearPlane, c != 0.0 && d / c > nearPlane ? d / c : UNBOUNDED_DEPTH};
}

void expand(core::DepthInterval& range, const core::Box3d& box, const glm::dmat4& toEye)
{
    for (int i = 0; i < 8; ++i) {
        const double depth = -(toEye * glm::dvec4(box.corner(i), 1.0)).z;
        range.nearDepth = std::min(range.nearDepth, depth);
        range.farDepth = std::max(range.farDepth, depth);
    }
}

// Finds the depths between the near and the far plane.
void findDepths(VolumeInstance& volume, const core::View& view)
{
    const core::DepthInterval clip = clipDepths(view.projection);
    const auto between = [&clip](const core::DepthInterval& range) {
        return core::DepthInterval{std::max(range.nearDepth, clip.nearDepth),
                                   std::min(range.farDepth, clip.farDepth)};
    };
    core::DepthInterval shown{UNBOUNDED_DEPTH, -UNBOUNDED_DEPTH}, whole = shown;
    const bool inFrame = volume.prepared->voxelFrame;
    for (const SelectedBrick& brick : volume.bricks)
        if (inFrame) expand(shown, brick.box, view.toEye);
    if (volume.bricks.empty() || !inFrame) expand(shown, volume.prepared->bounds, view.toEye);
    expand(whole, volume.prepared->regionBox, view.toEye);
    volume.depth = between(shown);
    volume.wholeDepth = between(whole);
}

// Puts the bricks in visibility order, far to near.
void sortBricks(VolumeInstance& volume, const core::View& view)
{
    if (volume.sorted || volume.bricks.size() < 2 || !volume.prepared->voxelFrame) return;
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
    volume.sorted = true;
}

} // namespace

bool placeInView(VolumeInstance& volume, osgUtil::RenderLeaf& leaf)
{
    const core::View view{toGlm(*leaf._modelview), toGlm(usualProjection(leaf))};
    findDepths(volume, view);
    if (!(volume.depth.nearDepth < volume.depth.farDepth)) return false;
    volume.leaf = &leaf;
    sortBricks(volume, view);
    return true;
}

VolumePart partOf(const VolumeInstance& volume)
{
    VolumePart part;
    part.look = volume.look;
    part.lights = volume.lights;
    part.paints = volume.paints;
    part.above = volume.above;
    part.features = volume.look->features;
    part.features.skipping = volume.skipping;
    part.features.countSamples = volume.countSamples;
    part.features.paintCount = volume.paints ? static_cast<int>(volume.paints->size()) : 0;
    part.step = volume.look->step;
    return part;
}

} // namespace render
} // namespace osgVolumizer
