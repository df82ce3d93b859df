#pragma once

#include "BrickTexture.h"

#include "../../Voxels.h"

#include <osg/RenderInfo>

namespace osgVolumizer {
namespace render {

/// A brick that a frame draws, and where its texels come from where the context lacks them.
struct DrawnBrick
{
    osg::ref_ptr<BrickTexture> texture; ///< null for none
    osg::ref_ptr<const Voxels> voxels;
    std::int64_t index = 0;
    bool gradients = false;
    bool paged = false;                    ///< `index` is a page's
    osg::ref_ptr<const osg::Image> texels; ///< of a page that the context may lack

    /// See BrickTexture::apply().
    CoarseTexture apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                        unsigned unit) const;

private:
    CoarseTexture applyPage(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                            unsigned unit) const;
};

} // namespace render
} // namespace osgVolumizer
