#pragma once

#include "../../VolumeSlice.h"
#include "ProgramFeatures.h"

#include <osg/StateSet>

namespace osgVolumizer {
namespace render {

/// What the shader of a slice has to do.
struct SectionFeatures
{
    ProgramFeatures voxels; ///< how values are interpolated; clip planes, fog
    bool slab = false;
    bool ramp = false; ///< the colours have two points
    VolumeSlice::Reduction reduction = VolumeSlice::MEAN;
    int brickCount = 1; ///< that a slab is drawn from at a time
    bool translucent = false;
};

/// The state that slices are drawn with; of translucent ones also blending and bin. Shared by all
/// with the same features.
osg::ref_ptr<osg::StateSet> sectionStateSet(const SectionFeatures& features);

} // namespace render
} // namespace osgVolumizer
