#pragma once

#include "../Export.h"

#include <vector>

namespace osgVolumizer {
namespace core {

/// Part of the depth axis, eye units.
struct DepthInterval
{
    double nearDepth = 0.0, farDepth = 0.0;

    double thickness() const { return farDepth - nearDepth; }
    bool overlaps(const DepthInterval& o) const
    {
        return nearDepth < o.farDepth && o.nearDepth < farDepth;
    }
};

/// Something translucent that takes part in a schedule.
struct ScheduleMember
{
    DepthInterval depth;
    bool volume = false;
    double step = 0.0; ///< volumes: depth between samples, > 0
};

/// Bounds the thickness of intervals that several members share, in steps of their finest volume.
struct ScheduleLimits
{
    double surfaceSteps = 16.0; ///< one volume with surfaces in it
    double volumeSteps = 1.0;   ///< several volumes
    int maximumCount = 1024;    ///< no more intervals than this, ever: they grow instead
};

/// An interval and those who have a part in it, by their numbers. With no surface and one volume it
/// is as long as can be; so it is with surfaces only.
struct ScheduledInterval
{
    DepthInterval depth;
    std::vector<int> volumes, surfaces;
    bool firstOfRun =
        true; ///< not a continuation of the one before (farther away) with the same members
};

/// Cuts the depths of all members into intervals, far to near, so that drawing the parts of one
/// interval and then those of the next composites in depth order, up to the thickness of shared
/// intervals. Members whose depth is empty or not finite are left out. Boundaries inside shared
/// intervals are multiples of the step, so that all volumes of a schedule sample one lattice of
/// depths.
OSGVOLUMIZER_CORE_EXPORT std::vector<ScheduledInterval>
depthSchedule(const std::vector<ScheduleMember>& members, const ScheduleLimits& limits = {});

} // namespace core
} // namespace osgVolumizer
