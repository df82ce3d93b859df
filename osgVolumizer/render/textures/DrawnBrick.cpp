#include "DrawnBrick.h"

#include "BrickResidency.h"

namespace osgVolumizer {
namespace render {

CoarseTexture DrawnBrick::apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                                unsigned unit) const
{
    // Called where the context lacks the texture.
    const auto load = [&]() {
        BrickResidency::of(*voxels)->makeRoom(*renderInfo.getState(), index, gradients, *texture);
        return BrickResidency::texels(*voxels, index, gradients);
    };
    return texture->apply(renderInfo, limits, load, unit);
}

} // namespace render
} // namespace osgVolumizer
