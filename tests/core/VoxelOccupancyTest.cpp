#include <osgVolumizer/core/voxels/Occupancy.h>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace VoxelOccupancyTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

std::vector<float> randomField(const glm::ivec3& size, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    std::vector<float> field(static_cast<std::size_t>(sampleCount(size)));
    for (float& v : field)
        v = uniform(random);
    return field;
}

} // namespace

TEST(VoxelOccupancy, CellsHoldEverySampleAFilterTouches)
{
    for (const glm::ivec3 size : {glm::ivec3(17, 9, 8), glm::ivec3(1, 1, 1), glm::ivec3(2, 33, 5)})
        for (const FilterSupport support : {FilterSupport::LINEAR, FilterSupport::CUBIC})
            for (const int cell : {1, 3, 8}) {
                std::vector<float> field = randomField(size, 3);
                field[field.size() / 2] = NAN;
                const VoxelView view{field.data(), VoxelType::FLOAT32, 1, size};
                const CellGrid grid = scanCells(view, cell, glm::dvec3(0.0), support);
                const int reach = static_cast<int>(support);
                for (int z = 0; z < grid.count.z; ++z)
                    for (int y = 0; y < grid.count.y; ++y)
                        for (int x = 0; x < grid.count.x; ++x) {
                            const glm::ivec3 c(x, y, z);
                            const Box3i samples{glm::max(c * cell - reach, glm::ivec3(0)),
                                                glm::min((c + 1) * cell + reach + 1, size)};
                            const ValueRange range = scanRange(view, samples);
                            const std::size_t i = grid.index(x, y, z);
                            if (range.empty()) {
                                ASSERT_GT(grid.low[i], grid.high[i]);
                                continue;
                            }
                            ASSERT_EQ(range.low, static_cast<double>(grid.low[i]));
                            ASSERT_EQ(range.high, static_cast<double>(grid.high[i]));
                        }
                // The cells reach the last sample, and no further than they must.
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_GE(grid.count[axis] * cell, size[axis] - 1);
                    EXPECT_LT((grid.count[axis] - 1) * cell, std::max(size[axis] - 1, 1));
                }
            }
}

TEST(VoxelOccupancy, RangesRoundOutwards)
{
    const double values[] = {0.1, 0.7};
    const CellGrid grid = scanCells({values, VoxelType::FLOAT64, 1, {2, 1, 1}}, 8);
    EXPECT_LE(static_cast<double>(grid.low[0]), 0.1);
    EXPECT_GE(static_cast<double>(grid.high[0]), 0.7);
    const std::int32_t large[] = {16777217, 16777217};
    const CellGrid integers = scanCells({large, VoxelType::INT32, 1, {2, 1, 1}}, 8);
    EXPECT_EQ(16777216.0f, integers.low[0]);
    EXPECT_EQ(16777218.0f, integers.high[0]);
}

TEST(VoxelOccupancy, OccupiedUnderAPredicate)
{
    std::vector<std::uint8_t> field(17 * 17 * 17, 10);
    field[16] = 200; // sample (16,0,0): the second cell along x only
    const CellGrid grid = scanCells({field.data(), VoxelType::UINT8, 1, {17, 17, 17}}, 8);
    ASSERT_EQ(glm::ivec3(2, 2, 2), grid.count);
    const auto occupied =
        occupiedCells(grid, [](double, double high) { return high > 100.0 ? 0.5 : 0.0; });
    for (std::size_t i = 0; i < occupied.size(); ++i)
        EXPECT_EQ(i == 1 ? 255 : 0, occupied[i]);
    const auto none = occupiedCells(
        grid, [](double, double) { return 0.5; }, 0.5);
    for (const std::uint8_t o : none)
        EXPECT_EQ(0, o);
}

TEST(VoxelOccupancy, DistanceIsChebyshevs)
{
    std::mt19937 random(11);
    for (int trial = 0; trial < 20; ++trial) {
        const glm::ivec3 n(1 + static_cast<int>(random() % 12), 1 + static_cast<int>(random() % 9),
                           1 + static_cast<int>(random() % 7));
        std::vector<std::uint8_t> occupied(static_cast<std::size_t>(sampleCount(n)), 0);
        for (std::uint8_t& o : occupied)
            o = random() % 40 == 0 ? 1 : 0;
        const auto distance = chebyshevDistance(n, occupied);
        const auto place = [&](std::size_t i) {
            const int k = static_cast<int>(i);
            return glm::ivec3(k % n.x, k / n.x % n.y, k / n.x / n.y);
        };
        for (std::size_t i = 0; i < occupied.size(); ++i) {
            int expected = 255;
            for (std::size_t j = 0; j < occupied.size(); ++j) {
                if (!occupied[j]) continue;
                const glm::ivec3 d = glm::abs(place(i) - place(j));
                expected = std::min(expected, std::max(d.x, std::max(d.y, d.z)));
            }
            ASSERT_EQ(expected, distance[i]);
        }
    }
}

TEST(VoxelOccupancy, DistanceSaturates)
{
    std::vector<std::uint8_t> occupied(600, 0);
    occupied[0] = 1;
    const auto distance = chebyshevDistance({600, 1, 1}, occupied);
    EXPECT_EQ(254, distance[254]);
    EXPECT_EQ(255, distance[255]);
    EXPECT_EQ(255, distance[599]);
}

} // namespace VoxelOccupancyTest
