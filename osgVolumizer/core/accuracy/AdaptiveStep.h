#pragma once

#include <algorithm>

namespace osgVolumizer {
namespace core {

/// Length of the steps along a ray that adapt: what a step is off by grows with the light that it
/// gives and with the square of its length, so it is as long as a bound on both allows. The bound
/// is in proportion to the period, so that errors are of second order in that.
struct AdaptiveStep
{
    static constexpr double SHORTEST = 0.25, LONGEST = 3.0; ///< periods
    /// Most of the light in a step of one period, where that is a voxel long.
    static constexpr double WEIGHT = 0.1;

    double stretch = 1.0; ///< length of the next step, periods

    /// Whether a step is short enough for the light that it gives, 0 to 1; sets the length of the
    /// next one, or of another try.
    bool suits(double light, double periodVoxel)
    {
        const double weight = light * stretch * stretch, most = WEIGHT * periodVoxel;
        const bool tooLong = weight > most && stretch > SHORTEST;
        if (tooLong)
            stretch = std::max(0.5 * stretch, SHORTEST);
        else if (8.0 * weight < most)
            stretch = std::min(2.0 * stretch, LONGEST);
        return !tooLong;
    }
};

} // namespace core
} // namespace osgVolumizer
