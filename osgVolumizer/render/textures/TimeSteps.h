#pragma once

#include "../../VolumeAppearance.h"

#include <osg/FrameStamp>

namespace osgVolumizer {
namespace render {

/// The time steps that a frame shows: one, or a blend of two.
struct TimeSteps
{
    int first = 0, second = 0; ///< the same where nothing is blended
    bool blended = false;      ///< drawn as a blend, even where that is of one
    float fraction = 0.0f;     ///< of the second

    int count() const { return blended ? 2 : 1; }
    int step(int i) const { return i == 0 ? first : second; }
    /// Whether the same pages are needed.
    bool sameSteps(const TimeSteps& o) const
    {
        return first == o.first && second == o.second && blended == o.blended;
    }
};

/// Those of an appearance with voxels at a frame.
TimeSteps timeStepsOf(const VolumeAppearance& appearance, const osg::FrameStamp* frame);
/// The steps that follow, after `ahead` changes of step, where time goes on by itself.
TimeSteps stepsAhead(const VolumeAppearance& appearance, const TimeSteps& steps, int ahead);

} // namespace render
} // namespace osgVolumizer
