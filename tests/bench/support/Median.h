#pragma once

#include <algorithm>
#include <vector>

namespace osgVolumizer {
namespace bench {

/// The middle value, or the mean of the two in the middle; 0 of none.
inline double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    const std::size_t middle = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

} // namespace bench
} // namespace osgVolumizer
