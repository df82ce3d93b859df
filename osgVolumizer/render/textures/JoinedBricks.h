#pragma once

#include "JoinedTexture.h"
#include "SelectedBrick.h"

#include "../../Voxels.h"

#include <osg/RenderInfo>

#include <vector>

namespace osgVolumizer {
namespace render {

/// The bricks of a volume that a view needs, in the texture that they share.
struct JoinedBricks
{
    osg::ref_ptr<JoinedTexture> texture;
    std::vector<JoinedPiece> pieces;
    osg::ref_ptr<const Voxels> voxels;
    bool gradients = false;
    std::vector<SelectedBrick> apart; ///< to draw one by one where the card refuses the texture

    /// See JoinedTexture::apply().
    bool apply(osg::RenderInfo& renderInfo, const ContextLimits& limits, unsigned unit) const;
};

} // namespace render
} // namespace osgVolumizer
