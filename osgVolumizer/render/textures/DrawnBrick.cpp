#include "DrawnBrick.h"

#include "BrickResidency.h"

#include <osg/Timer>

#include <optional>

namespace osgVolumizer {
namespace render {

CoarseTexture DrawnBrick::apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                                unsigned unit) const
{
    if (paged) return applyPage(renderInfo, limits, unit);
    // Called where the context lacks the texture.
    const auto load = [&]() {
        BrickResidency::of(*voxels)->makeRoom(*renderInfo.getState(), index, gradients, *texture);
        return BrickResidency::texels(*voxels, index, gradients);
    };
    BrickChanges changes;
    changes.modifiedCount = voxels->getModifiedCount(index);
    changes.origin = voxels->getLayout().brick(index).samples.min;
    changes.since = [this](unsigned modifiedCount) {
        return BrickResidency::changes(*voxels, index, gradients, modifiedCount);
    };
    changes.load = [this](const core::Box3i& box) {
        return BrickResidency::texels(*voxels, index, gradients, box);
    };
    return texture->apply(renderInfo, limits, load, unit, &changes);
}

// Nothing is read here: what the context has lost since the frame was culled is left out.
CoarseTexture DrawnBrick::applyPage(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                                    unsigned unit) const
{
    for (const DrawnBrick& brick : uploads)
        brick.applyPage(renderInfo, limits, unit);
    osg::State& state = *renderInfo.getState();
    std::optional<osg::Timer_t> start;
    const auto load = [&]() {
        if (texels) Pages::makeRoom(state, *texture);
        start = osg::Timer::instance()->tick();
        return texels;
    };
    const CoarseTexture applied = texture->apply(renderInfo, limits, load, unit);
    if (start && texels)
        UploadAllowance::of(state.getContextID())
            .measured(texture->bytes(),
                      osg::Timer::instance()->delta_m(*start, osg::Timer::instance()->tick()));
    return applied;
}

} // namespace render
} // namespace osgVolumizer
