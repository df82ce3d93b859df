#pragma once

#include "BrickCells.h"
#include "DrawnBrick.h"
#include "PreparedGeometry.h"
#include "TableTextures.h"
#include "VolumeDrawable.h"

#include "../VolumeAppearance.h"
#include "../VolumeGeometry.h"
#include "../core/ordering/DepthSchedule.h"

#include <osgUtil/RenderLeaf>

#include <vector>

namespace osgVolumizer {
namespace render {

/// A brick that this frame may have to draw.
struct SelectedBrick
{
    std::int64_t index = 0;
    core::Box3d box;     ///< frame; clip box, cut down to the geometry and to what shows
    core::Box3d clipBox; ///< voxel frame
    DrawnBrick texels;   ///< none where joined
    glm::vec3 textureScale{1.0f}, textureOffset{0.0f};
    std::shared_ptr<const BrickCells> cells;    ///< null where nothing is known
    std::shared_ptr<const JoinedBricks> joined; ///< null for one brick with a texture of its own
    int brickCount = 1;                         ///< how many it stands for
};

/// One volume in one view of one frame, from cull to sort.
struct VolumeInstance
{
    osg::ref_ptr<const VolumeGeometry> geometry;
    osg::ref_ptr<const VolumeAppearance> appearance;
    std::shared_ptr<const PreparedGeometry> prepared;
    std::shared_ptr<const VolumeLook> look;
    osg::ref_ptr<osg::RefMatrix> frameToEye; ///< model-view of the leaf
    osg::ref_ptr<VolumeDrawable> drawable; ///< of the leaf that stands for the volume until sorting
    std::vector<SelectedBrick> bricks;
    /// What selection found: bricks that show nothing, bricks of one value; cells in the boxes of
    /// the others, and those of them that show something.
    std::int64_t emptyBricks = 0, homogeneousBricks = 0, cellCount = 0, occupiedCells = 0;
    double cellSize = 8.0; ///< voxels
    core::SamplingParameters sampling;
    std::uint64_t viewId = 0; ///< see viewIdOf()

    // Known once sorting begins:
    osgUtil::RenderLeaf* leaf = nullptr;
    core::DepthInterval depth; ///< of the selected bricks, in front of the near plane
    /// The same of all the volume: where its samples are counted from, whatever is left out.
    core::DepthInterval wholeDepth;
};

} // namespace render
} // namespace osgVolumizer
