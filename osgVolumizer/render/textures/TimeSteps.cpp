#include "TimeSteps.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

// What paints others is looked up by their shader, a single step of it.
bool blends(const VolumeAppearance& appearance)
{
    return appearance.getTimeBlending() && appearance.getVoxels()->getStepCount() > 1 &&
           appearance.getCombineRule() != VolumeAppearance::PAINT;
}

} // namespace

TimeSteps timeStepsOf(const VolumeAppearance& appearance, const osg::FrameStamp* frame)
{
    const int last = appearance.getVoxels()->getStepCount() - 1;
    TimeSteps steps;
    if (last == 0) return steps;
    const double at = appearance.getTimeStepAt(frame ? frame->getSimulationTime() : 0.0);
    steps.first = steps.second = std::clamp(static_cast<int>(std::floor(at)), 0, last);
    steps.blended = blends(appearance);
    if (!steps.blended) return steps;
    steps.second = std::min(steps.first + 1, last);
    steps.fraction = static_cast<float>(at - steps.first);
    return steps;
}

TimeSteps stepsAhead(const VolumeAppearance& appearance, const TimeSteps& steps, int ahead)
{
    const int count = appearance.getVoxels()->getStepCount();
    const int way = appearance.getTimeRate() < 0.0 ? -ahead : ahead;
    TimeSteps next = steps;
    // A blend begins with any step but the last.
    const int beginnings = steps.blended ? std::max(count - 1, 1) : count;
    next.first = ((steps.first + way) % beginnings + beginnings) % beginnings;
    next.second = steps.blended ? std::min(next.first + 1, count - 1) : next.first;
    return next;
}

} // namespace render
} // namespace osgVolumizer
