#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/core/voxels/VoxelDispatch.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

namespace VoxelDataTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

const VoxelType allTypes[] = {VoxelType::INT8,   VoxelType::UINT8,   VoxelType::INT16,
                              VoxelType::UINT16, VoxelType::INT32,   VoxelType::UINT32,
                              VoxelType::HALF,   VoxelType::FLOAT32, VoxelType::FLOAT64};

/// Voxels of any type from a list of numbers.
std::vector<unsigned char> encode(const std::vector<double>& values, VoxelType type)
{
    std::vector<unsigned char> bytes(values.size() * voxelTypeSize(type));
    convertVoxels(values.data(), VoxelType::FLOAT64, bytes.data(), type, values.size());
    return bytes;
}

} // namespace

TEST(Half, EveryBitPatternRoundTrips)
{
    for (unsigned bits = 0; bits < 65536; ++bits) {
        const float value = Half::decode(static_cast<std::uint16_t>(bits));
        if (std::isnan(value))
            EXPECT_TRUE(std::isnan(Half::decode(Half::encode(value))));
        else
            ASSERT_EQ(bits, Half::encode(value)) << value;
    }
}

TEST(Half, RoundsToNearestEven)
{
    EXPECT_EQ(1.0f, static_cast<float>(Half(1.0f + std::ldexp(1.0f, -11))));
    EXPECT_EQ(1.0f + std::ldexp(1.0f, -9),
              static_cast<float>(Half(1.0f + 3 * std::ldexp(1.0f, -11))));
    EXPECT_EQ(65504.0f, static_cast<float>(Half(65519.0f)));
    EXPECT_TRUE(std::isinf(static_cast<float>(Half(65520.0f))));
    EXPECT_EQ(std::ldexp(1.0f, -24), static_cast<float>(Half(std::ldexp(0.9f, -24))));
}

TEST(VoxelData, RangeOfARegionForEveryType)
{
    // 70 samples a row, so that both the vectorised part and the rest are met.
    const glm::ivec3 size(70, 3, 2);
    std::vector<double> values(static_cast<std::size_t>(sampleCount(size)), 20.0);
    values[0] = 3.0;                      // outside the region below
    values[70 + 5] = 7.0;                 // (5,1,0)
    values[3 * 70 + 2 * 70 + 69] = 100.0; // (69,2,1)
    for (const VoxelType type : allTypes) {
        const auto bytes = encode(values, type);
        const VoxelView view{bytes.data(), type, 1, size};
        const ValueRange all = scanRange(view);
        EXPECT_EQ(3.0, all.low) << voxelTypeName(type);
        EXPECT_EQ(100.0, all.high) << voxelTypeName(type);
        const ValueRange part = scanRange(view, Box3i{{1, 1, 0}, {69, 3, 2}});
        EXPECT_EQ(7.0, part.low) << voxelTypeName(type);
        EXPECT_EQ(20.0, part.high) << voxelTypeName(type);
    }
}

TEST(VoxelData, RangeOfExtremeValues)
{
    for (const VoxelType type : allTypes) {
        double low = 0, high = 0;
        voxelTypeRange(type, low, high);
        const auto bytes = encode({low, high}, type);
        const ValueRange range = scanRange({bytes.data(), type, 1, {2, 1, 1}});
        EXPECT_EQ(low, range.low);
        EXPECT_EQ(high, range.high);
    }
}

TEST(VoxelData, RangeIgnoresNanAndInfinity)
{
    const double nan = std::nan(""), infinity = INFINITY;
    for (const VoxelType type : {VoxelType::HALF, VoxelType::FLOAT32, VoxelType::FLOAT64}) {
        std::vector<double> values(100, nan);
        values[3] = infinity;
        values[64] = -infinity;
        auto bytes = encode(values, type);
        EXPECT_TRUE(scanRange({bytes.data(), type, 1, {100, 1, 1}}).empty());
        values[40] = -5.0;
        values[99] = 4.0;
        bytes = encode(values, type);
        const ValueRange range = scanRange({bytes.data(), type, 1, {100, 1, 1}});
        EXPECT_EQ(-5.0, range.low);
        EXPECT_EQ(4.0, range.high);
    }
}

TEST(VoxelData, RangeOfOneComponent)
{
    const std::vector<unsigned char> rgba = {1, 2, 3, 40, 5, 6, 7, 80};
    const ValueRange alpha = scanRange({rgba.data(), VoxelType::UINT8, 4, {2, 1, 1}}, 3);
    EXPECT_EQ(40.0, alpha.low);
    EXPECT_EQ(80.0, alpha.high);
}

TEST(VoxelData, CopyAndPasteAreInverse)
{
    const glm::ivec3 size(7, 5, 4);
    std::vector<std::uint16_t> from(140), to(140, 9999);
    std::iota(from.begin(), from.end(), std::uint16_t(0));
    const Box3i region{{2, 1, 1}, {6, 4, 3}};
    std::vector<std::uint16_t> part(static_cast<std::size_t>(sampleCount(region.size())));
    copyRegion({from.data(), VoxelType::UINT16, 1, size}, region, part.data());
    EXPECT_EQ(from[2 + 7 * (1 + 5 * 1)], part.front());
    EXPECT_EQ(from[5 + 7 * (3 + 5 * 2)], part.back());
    pasteRegion(part.data(), region, VoxelType::UINT16, 1, size, to.data());
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 7; ++x) {
                const bool inside = x >= 2 && x < 6 && y >= 1 && y < 4 && z >= 1 && z < 3;
                const std::size_t i = static_cast<std::size_t>(x + 7 * (y + 5 * z));
                EXPECT_EQ(inside ? from[i] : 9999, to[i]);
            }
}

TEST(VoxelData, ConversionKeepsCalibratedValues)
{
    std::vector<double> values(256);
    std::iota(values.begin(), values.end(), -128.0);
    for (const VoxelType wide : {VoxelType::INT16, VoxelType::INT32, VoxelType::HALF,
                                 VoxelType::FLOAT32, VoxelType::FLOAT64}) {
        const auto narrow = encode(values, VoxelType::INT8);
        std::vector<unsigned char> bytes(256 * voxelTypeSize(wide));
        convertVoxels(narrow.data(), VoxelType::INT8, bytes.data(), wide, 256);
        for (std::int64_t i = 0; i < 256; ++i)
            EXPECT_EQ(values[static_cast<std::size_t>(i)],
                      voxelValue({bytes.data(), wide, 1, {256, 1, 1}}, i));
    }
}

TEST(VoxelData, ConversionRoundsAndHolds)
{
    const std::vector<double> values = {-1.0, 0.5, 1.5, 254.6, 300.0, std::nan(""), INFINITY};
    const auto bytes = encode(values, VoxelType::UINT8);
    EXPECT_EQ((std::vector<unsigned char>{0, 0, 2, 255, 255, 0, 255}), bytes);
    const auto wide = encode({4294967295.0, -3.0}, VoxelType::UINT32);
    EXPECT_EQ(4294967295.0, voxelValue({wide.data(), VoxelType::UINT32, 1, {2, 1, 1}}, 0));
    EXPECT_EQ(0.0, voxelValue({wide.data(), VoxelType::UINT32, 1, {2, 1, 1}}, 1));
}

TEST(VoxelData, ConversionInPlaceWithScale)
{
    std::vector<float> values = {0.0f, 0.5f, 1.0f};
    convertVoxels(values.data(), VoxelType::FLOAT32, values.data(), VoxelType::UINT16, 3, 1000.0,
                  10.0);
    std::uint16_t result[3];
    std::memcpy(result, values.data(), sizeof(result));
    EXPECT_EQ(10, result[0]);
    EXPECT_EQ(510, result[1]);
    EXPECT_EQ(1010, result[2]);
}

TEST(VoxelData, SwapBytes)
{
    std::uint16_t two[] = {0x0102, 0x0304};
    swapBytes(two, 2, 2);
    EXPECT_EQ(0x0201, two[0]);
    EXPECT_EQ(0x0403, two[1]);
    std::uint32_t four = 0x01020304;
    swapBytes(&four, 4, 1);
    EXPECT_EQ(0x04030201u, four);
    std::uint64_t eight = 0x0102030405060708;
    swapBytes(&eight, 8, 1);
    EXPECT_EQ(0x0807060504030201u, eight);
}

TEST(VoxelData, SizesSaturate)
{
    EXPECT_EQ(0, sampleCount({0, 5, 5}));
    EXPECT_EQ(std::int64_t(1) << 33, sampleCount({2048, 2048, 2048}));
    const int huge = 2147483647;
    EXPECT_EQ(std::numeric_limits<std::int64_t>::max(), sampleCount({huge, huge, huge}));
    EXPECT_EQ(std::numeric_limits<std::int64_t>::max(),
              voxelBytes({huge, huge, 2}, VoxelType::FLOAT64, 4));
}

} // namespace VoxelDataTest
