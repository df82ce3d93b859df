#include "Extent.h"

#include <osgVolumizer/core/Text.h>

#include <cstdlib>

namespace osgVolumizer {
namespace vtkimage {

namespace {

std::int64_t product(const std::int64_t (&n)[3])
{
    constexpr std::int64_t MOST = std::int64_t(1) << 62;
    std::int64_t all = 1;
    for (const std::int64_t i : n)
        all = i > 0 && all > MOST / i ? MOST : all * i;
    return all;
}

} // namespace

bool Extent::parse(const std::string& text)
{
    constexpr std::int64_t FURTHEST = std::int64_t(1) << 30;
    const auto words = core::splitBlanks(text);
    if (words.size() != 6) return false;
    for (std::size_t i = 0; i < 6; ++i) {
        std::int64_t& end = i % 2 ? high[i / 2] : low[i / 2];
        if (!core::parseInteger(words[i], end) || std::abs(end) > FURTHEST) return false;
    }
    return low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2];
}

std::int64_t Extent::points() const
{
    return product({points(0), points(1), points(2)});
}

std::int64_t Extent::cells(const Extent& whole) const
{
    std::int64_t n[3];
    for (int axis = 0; axis < 3; ++axis)
        n[axis] = whole.points(axis) > 1 ? points(axis) - 1 : 1;
    return product(n);
}

} // namespace vtkimage
} // namespace osgVolumizer
