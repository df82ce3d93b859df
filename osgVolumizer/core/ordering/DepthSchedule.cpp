#include "DepthSchedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

bool takesPart(const ScheduleMember& m)
{
    return m.depth.nearDepth < m.depth.farDepth && std::isfinite(m.depth.nearDepth) &&
           std::isfinite(m.depth.farDepth);
}

// Intervals between neighbouring ends of members, far to near, with those who are active in each;
// equal neighbours are joined.
std::vector<ScheduledInterval> elementaryIntervals(const std::vector<ScheduleMember>& members)
{
    std::vector<double> ends;
    for (const ScheduleMember& m : members) {
        if (!takesPart(m)) continue;
        ends.push_back(m.depth.nearDepth);
        ends.push_back(m.depth.farDepth);
    }
    std::sort(ends.begin(), ends.end(), std::greater<double>());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<ScheduledInterval> result;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        ScheduledInterval interval;
        interval.depth = {ends[i + 1], ends[i]};
        for (std::size_t k = 0; k < members.size(); ++k) {
            if (!takesPart(members[k]) || !members[k].depth.overlaps(interval.depth)) continue;
            (members[k].volume ? interval.volumes : interval.surfaces)
                .push_back(static_cast<int>(k));
        }
        if (interval.volumes.empty() && interval.surfaces.empty()) continue;
        // Surfaces by themselves need no order of ours: one stretch, whoever starts or ends in it.
        if (!result.empty() && interval.volumes.empty() && result.back().volumes.empty() &&
            result.back().depth.nearDepth == interval.depth.farDepth) {
            ScheduledInterval& last = result.back();
            last.depth.nearDepth = interval.depth.nearDepth;
            for (int k : interval.surfaces)
                if (std::find(last.surfaces.begin(), last.surfaces.end(), k) == last.surfaces.end())
                    last.surfaces.push_back(k);
            continue;
        }
        result.push_back(std::move(interval));
    }
    return result;
}

// 0: needs no cutting.
double wantedThickness(const ScheduledInterval& interval,
                       const std::vector<ScheduleMember>& members, const ScheduleLimits& limits)
{
    if (interval.volumes.empty()) return 0.0;
    if (interval.volumes.size() == 1 && interval.surfaces.empty()) return 0.0;
    double step = std::numeric_limits<double>::infinity();
    for (int v : interval.volumes)
        step = std::min(step, members[static_cast<std::size_t>(v)].step);
    return step * (interval.volumes.size() > 1 ? limits.volumeSteps : limits.surfaceSteps);
}

// Cuts at multiples of the thickness.
void appendCut(const ScheduledInterval& whole, double thickness,
               std::vector<ScheduledInterval>& result)
{
    ScheduledInterval part = whole;
    double farDepth = whole.depth.farDepth;
    // A remainder below 1e-9 of a step is rounding, not an interval.
    double cell = std::ceil(farDepth / thickness - 1e-9) - 1.0;
    for (bool first = true; farDepth > whole.depth.nearDepth; cell -= 1.0, first = false) {
        const double next = cell * thickness;
        part.depth.farDepth = farDepth;
        const bool inside = next < farDepth && next > whole.depth.nearDepth + 1e-9 * thickness;
        part.depth.nearDepth = inside ? next : whole.depth.nearDepth;
        part.firstOfRun = first;
        result.push_back(part);
        farDepth = part.depth.nearDepth;
    }
}

} // namespace

std::vector<ScheduledInterval> depthSchedule(const std::vector<ScheduleMember>& members,
                                             const ScheduleLimits& limits)
{
    const std::vector<ScheduledInterval> elementary = elementaryIntervals(members);
    double count = 0.0;
    for (const ScheduledInterval& interval : elementary) {
        const double thickness = wantedThickness(interval, members, limits);
        count += thickness > 0.0 ? interval.depth.thickness() / thickness + 1.0 : 1.0;
    }
    const double growth = std::max(1.0, count / std::max(1, limits.maximumCount));
    std::vector<ScheduledInterval> result;
    for (const ScheduledInterval& interval : elementary) {
        const double thickness = growth * wantedThickness(interval, members, limits);
        if (thickness > 0.0)
            appendCut(interval, thickness, result);
        else
            result.push_back(interval);
    }
    return result;
}

} // namespace core
} // namespace osgVolumizer
