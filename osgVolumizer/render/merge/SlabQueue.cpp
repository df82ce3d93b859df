#include "SlabQueue.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

void SlabQueue::add(const core::DepthInterval& interval, const std::vector<int>& order)
{
    for (int number : order) {
        const auto volume = static_cast<std::size_t>(number);
        if (_volume != volume) flush();
        _volume = volume;
        _intervals.push_back(interval);
    }
}

void SlabQueue::flush()
{
    if (_intervals.empty()) return;
    const MergedVolume& volume = _group.volumes()[_volume];
    _group.addVolume(volume, _group.meshOf(volume, _intervals), _parts[_volume],
                     middleOf(_intervals.front()), _leaves);
    _intervals.clear();
}

std::vector<int> alternatingOrder(const core::ScheduledInterval& interval, std::size_t number)
{
    std::vector<int> order = interval.volumes;
    if (number % 2 == 1) std::reverse(order.begin(), order.end());
    return order;
}

std::vector<core::ScheduledInterval> scheduleOf(const MergedGroup& group,
                                                const std::vector<std::size_t>& surfaces)
{
    std::vector<core::ScheduleMember> members;
    core::ScheduleLimits limits;
    for (const MergedVolume& volume : group.volumes()) {
        members.push_back({volume.depth, true, group.step()});
        // A slice has no inside that surfaces could split.
        if (volume.sliced) limits.surfaceSteps = 1.0;
    }
    for (std::size_t s : surfaces) {
        const MergedSurface& surface = group.surfaces()[s];
        members.push_back({surface.view.depth, false, 0.0});
        // What leaves no depth cannot split a segment either.
        if (!surface.leavesDepth()) limits.surfaceSteps = 1.0;
    }
    return core::depthSchedule(members, limits);
}

} // namespace render
} // namespace osgVolumizer
