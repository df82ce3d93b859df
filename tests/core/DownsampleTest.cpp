#include <osgVolumizer/core/voxels/Downsample.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace DownsampleTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

template <class T>
std::vector<T> coarser(const std::vector<T>& fine, const glm::ivec3& size, VoxelType type,
                       LevelRule rule = LevelRule::MEAN, int components = 1)
{
    const glm::ivec3 half = (size + 1) / 2;
    std::vector<T> coarse(std::size_t(half.x * half.y * half.z * components));
    downsample(fine.data(), size, type, components, rule, coarse.data());
    return coarse;
}

TEST(Downsample, MeansOfEightWithWhatThereIsAtTheEnds)
{
    std::vector<float> ramp;
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 5; ++x)
                ramp.push_back(float(x + 10 * y + 100 * z));
    const auto coarse = coarser(ramp, {5, 4, 3}, VoxelType::FLOAT32);
    ASSERT_EQ(coarse.size(), 12u);
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x) {
                const double expected = (x == 2 ? 4.0 : 2 * x + 0.5) + 10.0 * (2 * y + 0.5) +
                                        100.0 * (z == 1 ? 2.0 : 0.5);
                EXPECT_FLOAT_EQ(coarse[std::size_t(x + 3 * (y + 2 * z))], float(expected));
            }
}

TEST(Downsample, IntegersAreRounded)
{
    const std::vector<std::uint8_t> fine{0, 1, 1, 1, 255, 255, 255, 254};
    EXPECT_EQ(coarser(fine, {2, 2, 2}, VoxelType::UINT8)[0], 128); // 127.75
    EXPECT_EQ(coarser(std::vector<std::int16_t>{-3, -4}, {2, 1, 1}, VoxelType::INT16)[0], -4);
}

TEST(Downsample, HolesDoNotSpread)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FLOAT_EQ(coarser(std::vector<float>{nan, 2, 4, nan}, {2, 2, 1}, VoxelType::FLOAT32)[0],
                    3.0f);
    EXPECT_TRUE(
        std::isnan(coarser(std::vector<float>{nan, nan}, {1, 2, 1}, VoxelType::FLOAT32)[0]));
}

TEST(Downsample, LabelsKeepTheMostFrequent)
{
    const std::vector<std::uint16_t> labels{7, 9, 9, 7, 9, 3, 3, 3, 5, 5, 0, 0};
    const auto coarse = coarser(labels, {2, 6, 1}, VoxelType::UINT16, LevelRule::MODE);
    EXPECT_EQ(coarse, (std::vector<std::uint16_t>{7, 3, 0})); // of two, the lower
}

TEST(Downsample, ColorsAreWeightedByAlpha)
{
    const std::vector<std::uint8_t> colors{200, 10, 0, 255, 0, 0, 255, 0};
    EXPECT_EQ(coarser(colors, {2, 1, 1}, VoxelType::UINT8, LevelRule::MEAN, 4),
              (std::vector<std::uint8_t>{200, 10, 0, 128}));
    const std::vector<std::uint8_t> clear{200, 10, 0, 0, 0, 0, 100, 0};
    EXPECT_EQ(coarser(clear, {2, 1, 1}, VoxelType::UINT8, LevelRule::MEAN, 4),
              (std::vector<std::uint8_t>{100, 5, 50, 0}));
}

} // namespace DownsampleTest
