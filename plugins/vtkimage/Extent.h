#pragma once

#include <cstdint>
#include <string>

namespace osgVolumizer {
namespace vtkimage {

/// The first and last point along each axis, as XML files write them: "0 9 0 9 0 4".
struct Extent
{
    std::int64_t low[3] = {0, 0, 0}, high[3] = {0, 0, 0};

    /// Six whole numbers in order, none beyond 2^30; false, and undefined, for anything else.
    bool parse(const std::string& text);
    std::int64_t points(int axis) const { return high[axis] - low[axis] + 1; }
    /// Of all axes; saturates at 2^62.
    std::int64_t points() const;
    /// As points() of cells, where an axis of one point has one; those of a part are counted along
    /// the axes of the whole.
    std::int64_t cells(const Extent& whole) const;
    std::int64_t cells() const { return cells(*this); }
};

} // namespace vtkimage
} // namespace osgVolumizer
