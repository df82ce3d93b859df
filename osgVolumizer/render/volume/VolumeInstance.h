#pragma once

#include "../draw/VolumeDrawable.h"
#include "../textures/SelectedBrick.h"
#include "../textures/TimeSteps.h"
#include "PreparedGeometry.h"
#include "TouchedBoxes.h"

#include "../../VolumeAppearance.h"
#include "../../VolumeGeometry.h"
#include "../../core/cutting/Cut.h"
#include "../../core/ordering/DepthSchedule.h"
#include "../../core/sampling/Polygonize.h"

#include <osgUtil/RenderLeaf>

#include <atomic>
#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// One volume in one view of one frame, from cull to sort.
struct VolumeInstance
{
    osg::ref_ptr<const VolumeGeometry> geometry;
    osg::ref_ptr<const VolumeAppearance> appearance;
    std::shared_ptr<const PreparedGeometry> prepared;
    std::shared_ptr<const VolumeLook> look;
    StateAbove above;
    std::vector<core::Plane> clipPlanes;  ///< frame; osg::ClipPlanes of the state above, cut
    std::shared_ptr<const core::Cut> cut; ///< null for none
    /// Of a VolumeSlice, which has no geometry, and of which only bricks are selected; else null.
    const TouchedBoxes* section = nullptr;
    bool joinsSection = false; ///< bricks are to be joined for it wherever they can be
    bool skipping = false;     ///< leap over cells that show nothing
    bool countSamples = false; ///< see ViewHooks
    osg::ref_ptr<osg::RefMatrix> frameToEye; ///< model-view of the leaf
    osg::ref_ptr<VolumeDrawable> drawable; ///< of the leaf that stands for the volume until sorting
    std::vector<SelectedBrick> bricks;
    bool sorted = false; ///< the bricks are in visibility order, far to near
    /// What selection found: bricks that show nothing, bricks of one value; cells in the boxes of
    /// the others, and those of them that show something.
    std::int64_t emptyBricks = 0, homogeneousBricks = 0, cellCount = 0, occupiedCells = 0;
    double cellSize = 8.0; ///< voxels
    core::SamplingParameters sampling;
    bool exactFiltering = false; ///< for an error tolerance, whatever the appearance says
    bool keepsError = false;     ///< the period was chosen for an error tolerance
    bool adaptsSteps = false;    ///< likewise: steps are as long as the light they give allows
    double rayDistance = 1.0;    ///< pixels between rays, where all of the volume is drawn at once
    std::uint64_t viewId = 0;    ///< see viewIdOf()
    TimeSteps steps;             ///< of voxels that have several

    /// Raised to the brightness of all lights once these are known; null where that does not
    /// matter.
    std::shared_ptr<std::atomic<double>> brightness;

    // Known once sorting begins:
    std::shared_ptr<const std::vector<EyeLight>> lights; ///< null where unlit
    std::shared_ptr<const std::vector<Paint>> paints;    ///< null for none
    osgUtil::RenderLeaf* leaf = nullptr;
    core::DepthInterval depth; ///< of the selected bricks, in front of the near plane
    /// The same of all the volume: where its samples are counted from, whatever is left out.
    core::DepthInterval wholeDepth;
};

/// Once near and far are final: finds the depths of the volume that a leaf stands for, and puts its
/// bricks in visibility order, far to near. False where nothing of it lies between near and far.
bool placeInView(VolumeInstance& volume, osgUtil::RenderLeaf& leaf);

/// All of a volume, everywhere, with what is known of it so far.
VolumePart partOf(const VolumeInstance& volume);

} // namespace render
} // namespace osgVolumizer
