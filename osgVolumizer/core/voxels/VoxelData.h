#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "VoxelType.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace osgVolumizer {
namespace core {

/// Voxels somewhere in memory: x fastest, then y, then z, tightly packed, native byte order.
struct VoxelView
{
    const void* data = nullptr;
    VoxelType type = VoxelType::UINT8;
    int components = 1;
    glm::ivec3 size{0}; ///< samples per axis

    std::size_t bytesPerVoxel() const
    {
        return voxelTypeSize(type) * static_cast<std::size_t>(components);
    }
};

/// Lowest and highest of a set of values, in data units; empty when low > high.
struct ValueRange
{
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    bool empty() const { return !(low <= high); }
    void expand(const ValueRange& o)
    {
        if (o.low < low) low = o.low;
        if (o.high > high) high = o.high;
    }
};

/// Number of samples, or of bytes, in a box of samples; 0 for an empty one. Saturates at 2^63 - 1.
OSGVOLUMIZER_CORE_EXPORT std::int64_t sampleCount(const glm::ivec3& size);
OSGVOLUMIZER_CORE_EXPORT std::int64_t voxelBytes(const glm::ivec3& size, VoxelType type,
                                                 int components);

/// One component of voxel `index`, as a number.
OSGVOLUMIZER_CORE_EXPORT double voxelValue(const VoxelView& view, std::int64_t index,
                                           int component = 0);

/// Range of one component over a region (inside the view). NaN and infinite values do not count:
/// they are holes. Empty when nothing else is there.
OSGVOLUMIZER_CORE_EXPORT ValueRange scanRange(const VoxelView& view, const Box3i& region,
                                              int component = 0);
OSGVOLUMIZER_CORE_EXPORT ValueRange scanRange(const VoxelView& view, int component = 0);

/// Copies the samples of a region (inside the view) to `destination`, tightly packed.
OSGVOLUMIZER_CORE_EXPORT void copyRegion(const VoxelView& view, const Box3i& region,
                                         void* destination);
/// The reverse: writes tightly packed samples into a region of a volume of `size` samples.
OSGVOLUMIZER_CORE_EXPORT void pasteRegion(const void* source, const Box3i& region, VoxelType type,
                                          int components, const glm::ivec3& size,
                                          void* destination);

/// destination = scale * source + offset for `count` values. Integers are rounded to nearest and
/// held within their type; NaN becomes 0 in them. Works in place (destination == source) where the
/// destination's type is no larger than the source's. With scale 1 and offset 0 values that the
/// destination can hold are kept exactly.
OSGVOLUMIZER_CORE_EXPORT void convertVoxels(const void* source, VoxelType sourceType,
                                            void* destination, VoxelType destinationType,
                                            std::size_t count, double scale = 1.0,
                                            double offset = 0.0);

/// Reverses the bytes of each of `count` elements of 1, 2, 4 or 8 bytes.
OSGVOLUMIZER_CORE_EXPORT void swapBytes(void* data, std::size_t elementSize, std::size_t count);

} // namespace core
} // namespace osgVolumizer
