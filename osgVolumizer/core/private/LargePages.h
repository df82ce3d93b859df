#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Asks the system to back memory that nothing has touched yet with large pages. Arrays of many
/// megabytes that are written in many places at once are limited by the translation of addresses
/// otherwise. Does nothing for small arrays, and where the system has no such thing.
void adviseLargePages(void* from, std::size_t bytes);

/// What growLarge() does where there is too little room.
template <class T>
void growLargeNow(std::vector<T>& values, std::size_t size, std::size_t keep)
{
    if (values.capacity() < size) {
        std::vector<T> grown;
        grown.reserve(keep == 0 ? size : size + size / 2);
        adviseLargePages(grown.data(), grown.capacity() * sizeof(T));
        grown.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(keep));
        values.swap(grown);
    }
    values.resize(std::min(values.capacity(), size + size / 16));
}

/// Makes `values` at least `size` long, in large pages where it has to grow. Its first `keep`
/// values survive, the others are undefined.
template <class T>
inline void growLarge(std::vector<T>& values, std::size_t size, std::size_t keep = 0)
{
    if (values.size() < size) growLargeNow(values, size, keep);
}

/// Makes `values` exactly `size` long; all of them are undefined.
template <class T>
void resizeLarge(std::vector<T>& values, std::size_t size)
{
    growLarge(values, size);
    values.resize(size);
}

} // namespace core
} // namespace osgVolumizer
