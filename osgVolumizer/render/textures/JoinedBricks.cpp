#include "JoinedBricks.h"

#include "BrickResidency.h"

namespace osgVolumizer {
namespace render {

bool JoinedBricks::apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                         unsigned unit) const
{
    osg::State& state = *renderInfo.getState();
    const unsigned context = state.getContextID();
    if (!texture->isIn(context) && !texture->isRefused(context))
        BrickResidency::of(*voxels)->makeRoom(state, BrickResidency::ALL_BRICKS, gradients,
                                              *texture);
    const auto load = [this](std::int64_t brick) {
        return BrickResidency::texels(*voxels, brick, gradients);
    };
    JoinedTexture::Changes changes;
    changes.since = [this](std::int64_t brick, unsigned modifiedCount) {
        return BrickResidency::changes(*voxels, brick, gradients, modifiedCount);
    };
    changes.load = [this](std::int64_t brick, const core::Box3i& box) {
        return BrickResidency::texels(*voxels, brick, gradients, box);
    };
    return texture->apply(renderInfo, limits, pieces, load, changes, unit);
}

} // namespace render
} // namespace osgVolumizer
