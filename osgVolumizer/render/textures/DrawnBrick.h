#pragma once

#include "BrickTexture.h"
#include "VisibilityTest.h"

#include "../../Voxels.h"

#include <osg/RenderInfo>

#include <cstdint>
#include <memory>
#include <vector>

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
    std::vector<DrawnBrick> uploads;       ///< pages for later frames, uploaded on the occasion
    /// Of a page: what to tell of whether it is visible, and as which page; or null.
    std::shared_ptr<VisibilityTest> test;
    std::int64_t testedAs = -1; ///< none: only whether there is anything opaque

    /// See BrickTexture::apply().
    CoarseTexture apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                        unsigned unit) const;

private:
    CoarseTexture applyPage(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                            unsigned unit) const;
};

} // namespace render
} // namespace osgVolumizer
