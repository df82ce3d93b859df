#include "Selection.h"

#include <algorithm>

namespace osgVolumizer {
namespace hdf5 {

std::vector<Segment> segmentsOf(int min, int max, int halvings, int samples)
{
    const std::int64_t stride = std::int64_t(1) << halvings, last = samples - 1;
    const std::int64_t start = min * stride + stride / 2;
    // Those whose middle the file has.
    const std::int64_t count =
        start > last ? 0 : std::min<std::int64_t>((last - start) / stride + 1, max - min);
    std::vector<Segment> segments;
    if (count > 0) segments.push_back({hsize_t(start), hsize_t(stride), hsize_t(count), 0});
    for (std::int64_t i = count; i < max - min; ++i)
        segments.push_back({hsize_t(last), 1, 1, hsize_t(i)});
    return segments;
}

Handle Selection::inFile(hid_t dataset, int rank, const Axes& where, int step) const
{
    Handle space(H5Dget_space(dataset), H5Sclose);
    hsize_t start[H5S_MAX_RANK] = {}, stride[H5S_MAX_RANK], count[H5S_MAX_RANK];
    std::fill_n(stride, rank, hsize_t(1));
    std::fill_n(count, rank, hsize_t(1));
    if (where.time >= 0) start[where.time] = hsize_t(step);
    for (int axis = 0; axis < 3; ++axis) {
        const int at = where.z + 2 - axis;
        start[at] = axes[axis].start;
        stride[at] = axes[axis].stride;
        count[at] = axes[axis].count;
    }
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, stride, count, nullptr);
    return space;
}

Handle Selection::inMemory(const glm::ivec3& size) const
{
    const hsize_t all[] = {hsize_t(size.z), hsize_t(size.y), hsize_t(size.x)};
    const hsize_t start[] = {axes[2].to, axes[1].to, axes[0].to};
    const hsize_t count[] = {axes[2].count, axes[1].count, axes[0].count};
    Handle space(H5Screate_simple(3, all, nullptr), H5Sclose);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr);
    return space;
}

std::vector<Selection> selectionsOf(const core::Box3i& region, int level, const FileLevel& from)
{
    std::vector<Segment> segments[3];
    for (int axis = 0; axis < 3; ++axis)
        segments[axis] = segmentsOf(region.min[axis], region.max[axis], level - from.halvings[axis],
                                    from.size[axis]);
    std::vector<Selection> selections;
    for (const Segment& z : segments[2])
        for (const Segment& y : segments[1])
            for (const Segment& x : segments[0])
                selections.push_back({{x, y, z}});
    return selections;
}

} // namespace hdf5
} // namespace osgVolumizer
