#include "AccumulationNeeds.h"

#include "../context/LeafState.h"
#include "BinScan.h"
#include "MergeGroups.h"
#include "ScreenAreas.h"

#include <glm/common.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

bool isForeign(const osgUtil::RenderLeaf& leaf)
{
    return !dynamic_cast<const VolumeDrawable*>(leaf.getDrawable());
}

bool isBetween(const osgUtil::RenderLeaf& leaf, const core::DepthInterval& ends)
{
    return leaf._depth >= ends.nearDepth && leaf._depth <= ends.farDepth;
}

// Whether something holds of any leaf that is drawn between the ends, or replaced.
template <class Predicate>
bool anyBetween(const AccumulatedLeaves& drawn, Predicate holds)
{
    return std::any_of(
        drawn.leaves.begin(), drawn.leaves.end(), [&](const osgUtil::RenderLeaf* leaf) {
            return (isBetween(*leaf, drawn.ends) || drawn.replaced.count(leaf)) && holds(*leaf);
        });
}

} // namespace

void tellNeeds(const AccumulatedLeaves& drawn, Accumulation& accumulation)
{
    if (anyBetween(drawn, [](const osgUtil::RenderLeaf& leaf) {
            return isForeign(leaf) && writesDepth(leaf._parent);
        }))
        accumulation.keepDepth();
    if (anyBetween(drawn, [](const osgUtil::RenderLeaf& leaf) {
            return isOn(leaf._parent, GL_STENCIL_TEST, false);
        }))
        accumulation.useStencil();
    if (anyBetween(drawn, [](const osgUtil::RenderLeaf& leaf) {
            return isForeign(leaf) && isOn(leaf._parent, GL_COLOR_LOGIC_OP, false);
        }))
        accumulation.keepFramebuffer();
}

void tellUnneeded(const AccumulatedLeaves& drawn, const std::vector<VolumeInstance*>& volumes,
                  const glm::ivec4* viewport, Accumulation& accumulation)
{
    bool alone = true, cleared = isDepthClearedBefore(drawn.bin);
    for (const osgUtil::RenderLeaf* leaf : drawn.leaves) {
        if (!isForeign(*leaf)) continue;
        alone = alone && !isBetween(*leaf, drawn.ends);
        cleared = cleared && (leaf->_depth < drawn.ends.nearDepth || !mayWriteDepth(*leaf));
    }
    if (alone && cleared) accumulation.expectClearedDepth();
    if (!alone || !viewport) return;
    ScreenRectangle screen = viewOf(*volumes.front()).screen;
    for (const VolumeInstance* volume : volumes) {
        const ScreenRectangle other = viewOf(*volume).screen;
        screen.min = glm::min(screen.min, other.min);
        screen.max = glm::max(screen.max, other.max);
    }
    accumulation.restrictTo(pixelRectangle(screen, *viewport, 4));
}

} // namespace render
} // namespace osgVolumizer
