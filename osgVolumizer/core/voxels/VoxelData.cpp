#include "VoxelData.h"

#include "VoxelDispatch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace osgVolumizer {
namespace core {

namespace {

/// Offset, in voxels, of a sample in a volume.
std::size_t offsetOf(const glm::ivec3& size, int x, int y, int z)
{
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(x);
}

/// The type to compare in: exact for every voxel type, and as narrow as can be.
template <class T>
using Compared = std::conditional_t<std::is_same<T, Half>::value, float, T>;

/// Running range of a row. Independent lanes, so that the compiler can use vector instructions even
/// where NaN forbids it to reorder comparisons.
template <class T>
struct RowScanner
{
    using C = Compared<T>;
    static constexpr std::size_t LANES = 32;
    static constexpr C LOWEST = std::numeric_limits<C>::lowest();
    static constexpr C HIGHEST = std::numeric_limits<C>::max();
    C low[LANES], high[LANES];

    RowScanner()
    {
        std::fill(low, low + LANES, HIGHEST);
        std::fill(high, high + LANES, LOWEST);
    }
    void add(std::size_t lane, C v)
    {
        if constexpr (std::is_floating_point<C>::value) {
            // Both comparisons are false for NaN; infinities are taken out by the bounds.
            const bool finite = v >= LOWEST && v <= HIGHEST;
            low[lane] = finite && v < low[lane] ? v : low[lane];
            high[lane] = finite && v > high[lane] ? v : high[lane];
        } else {
            low[lane] = std::min(low[lane], v);
            high[lane] = std::max(high[lane], v);
        }
    }
    void row(const T* values, std::size_t count, std::size_t stride)
    {
        std::size_t i = 0;
        if (stride == 1)
            for (; i + LANES <= count; i += LANES)
                for (std::size_t l = 0; l < LANES; ++l)
                    add(l, static_cast<C>(values[i + l]));
        for (; i < count; ++i)
            add(0, static_cast<C>(values[i * stride]));
    }
    ValueRange range() const
    {
        const C lowest = *std::min_element(low, low + LANES);
        const C highest = *std::max_element(high, high + LANES);
        if (lowest > highest) return {};
        return {static_cast<double>(lowest), static_cast<double>(highest)};
    }
};

template <class To>
To converted(double v)
{
    if constexpr (std::is_integral<To>::value) {
        constexpr double lowest = std::numeric_limits<To>::lowest();
        constexpr double highest = std::numeric_limits<To>::max();
        if (!(v >= lowest)) return v < lowest ? std::numeric_limits<To>::lowest() : To(0);
        return v > highest ? std::numeric_limits<To>::max() : static_cast<To>(std::nearbyint(v));
    } else if constexpr (std::is_same<To, double>::value) {
        return v;
    } else {
        return To(static_cast<float>(v));
    }
}

template <std::size_t SIZE>
void reverseElements(unsigned char* bytes, std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i)
        std::reverse(bytes + i * SIZE, bytes + (i + 1) * SIZE);
}

} // namespace

std::int64_t sampleCount(const glm::ivec3& size)
{
    if (size.x < 1 || size.y < 1 || size.z < 1) return 0;
    const std::int64_t slice = std::int64_t(size.x) * size.y;
    constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();
    return slice > highest / size.z ? highest : slice * size.z;
}

std::int64_t voxelBytes(const glm::ivec3& size, VoxelType type, int components)
{
    const std::int64_t samples = sampleCount(size);
    const std::int64_t bytes =
        static_cast<std::int64_t>(voxelTypeSize(type)) * std::max(components, 0);
    constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();
    return bytes > 0 && samples > highest / bytes ? highest : samples * bytes;
}

double voxelValue(const VoxelView& view, std::int64_t index, int component)
{
    return visitVoxelType(view.type, [&](auto tag) {
        using T = decltype(tag);
        const T* values = static_cast<const T*>(view.data);
        return static_cast<double>(values[index * view.components + component]);
    });
}

ValueRange scanRange(const VoxelView& view, const Box3i& region, int component)
{
    if (region.empty()) return {};
    return visitVoxelType(view.type, [&](auto tag) {
        using T = decltype(tag);
        const std::size_t stride = static_cast<std::size_t>(view.components);
        RowScanner<T> scanner;
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                scanner.row(static_cast<const T*>(view.data) +
                                offsetOf(view.size, region.min.x, y, z) * stride +
                                static_cast<std::size_t>(component),
                            static_cast<std::size_t>(region.size().x), stride);
        return scanner.range();
    });
}

ValueRange scanRange(const VoxelView& view, int component)
{
    return scanRange(view, Box3i{glm::ivec3(0), view.size}, component);
}

void copyRegion(const VoxelView& view, const Box3i& region, void* destination)
{
    if (region.empty()) return;
    const std::size_t voxel = view.bytesPerVoxel();
    const std::size_t row = static_cast<std::size_t>(region.size().x) * voxel;
    auto* to = static_cast<unsigned char*>(destination);
    for (int z = region.min.z; z < region.max.z; ++z)
        for (int y = region.min.y; y < region.max.y; ++y, to += row)
            std::memcpy(to,
                        static_cast<const unsigned char*>(view.data) +
                            offsetOf(view.size, region.min.x, y, z) * voxel,
                        row);
}

void pasteRegion(const void* source, const Box3i& region, VoxelType type, int components,
                 const glm::ivec3& size, void* destination)
{
    if (region.empty()) return;
    const std::size_t voxel = voxelTypeSize(type) * static_cast<std::size_t>(components);
    const std::size_t row = static_cast<std::size_t>(region.size().x) * voxel;
    auto* from = static_cast<const unsigned char*>(source);
    for (int z = region.min.z; z < region.max.z; ++z)
        for (int y = region.min.y; y < region.max.y; ++y, from += row)
            std::memcpy(static_cast<unsigned char*>(destination) +
                            offsetOf(size, region.min.x, y, z) * voxel,
                        from, row);
}

void convertVoxels(const void* source, VoxelType sourceType, void* destination,
                   VoxelType destinationType, std::size_t count, double scale, double offset)
{
    if (sourceType == destinationType && scale == 1.0 && offset == 0.0) {
        std::memmove(destination, source, count * voxelTypeSize(sourceType));
        return;
    }
    visitVoxelType(sourceType, [&](auto sourceTag) {
        visitVoxelType(destinationType, [&](auto destinationTag) {
            using From = decltype(sourceTag);
            using To = decltype(destinationTag);
            // Byte copies, because both may lie in the same memory under different types.
            auto* from = static_cast<const unsigned char*>(source);
            auto* to = static_cast<unsigned char*>(destination);
            for (std::size_t i = 0; i < count; ++i, from += sizeof(From), to += sizeof(To)) {
                From value;
                std::memcpy(&value, from, sizeof(From));
                const To result = converted<To>(scale * static_cast<double>(value) + offset);
                std::memcpy(to, &result, sizeof(To));
            }
        });
    });
}

void swapBytes(void* data, std::size_t elementSize, std::size_t count)
{
    auto* bytes = static_cast<unsigned char*>(data);
    if (elementSize == 2) reverseElements<2>(bytes, count);
    if (elementSize == 4) reverseElements<4>(bytes, count);
    if (elementSize == 8) reverseElements<8>(bytes, count);
}

} // namespace core
} // namespace osgVolumizer
