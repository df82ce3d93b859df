#include "DrawnBrick.h"

#include "BrickResidency.h"

namespace osgVolumizer {
namespace render {

CoarseTexture DrawnBrick::apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                                unsigned unit) const
{
    return texture->apply(
        renderInfo, limits, [this]() { return BrickResidency::texels(*voxels, index, gradients); },
        unit);
}

} // namespace render
} // namespace osgVolumizer
