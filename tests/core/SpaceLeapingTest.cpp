#include "osgVolumizer/core/geometry/SpaceLeaping.h"
#include "osgVolumizer/core/geometry/TetraMesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace SpaceLeapingTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

const glm::ivec3 CELLS(37, 20, 18);

/// Distance of the cell from a centre, so that thresholds give balls.
std::vector<CellRange> ball()
{
    std::vector<CellRange> r;
    for (int z = 0; z < CELLS.z; ++z)
        for (int y = 0; y < CELLS.y; ++y)
            for (int x = 0; x < CELLS.x; ++x) {
                const float d =
                    std::sqrt(float((x - 12) * (x - 12) + (y - 9) * (y - 9) + (z - 8) * (z - 8)));
                r.push_back({d - 0.5f, d + 0.5f});
            }
    return r;
}

void expectExactCover(const SpaceLeaper& leaper)
{
    std::vector<int> times(std::size_t(CELLS.x) * CELLS.y * CELLS.z, 0);
    for (const Box3i& b : leaper.boxes())
        for (int z = b.min.z; z < b.max.z; ++z)
            for (int y = b.min.y; y < b.max.y; ++y)
                for (int x = b.min.x; x < b.max.x; ++x)
                    ++times[std::size_t((z * CELLS.y + y) * CELLS.x + x)];
    for (int z = 0; z < CELLS.z; ++z)
        for (int y = 0; y < CELLS.y; ++y)
            for (int x = 0; x < CELLS.x; ++x)
                ASSERT_EQ(times[std::size_t((z * CELLS.y + y) * CELLS.x + x)],
                          leaper.occupied({x, y, z}) ? 1 : 0);
}

} // namespace

TEST(SpaceLeaping, CoversOccupiedCellsOnceWithFewBoxes)
{
    SpaceLeaper leaper;
    ASSERT_TRUE(leaper.setRanges(CELLS, ball()).ok());
    EXPECT_TRUE(leaper.update([](float low, float) { return low < 7.0f; }));
    expectExactCover(leaper);
    EXPECT_GT(leaper.occupiedCells(), 1000);
    EXPECT_LT(std::int64_t(leaper.boxes().size()) * 6, leaper.occupiedCells());
    EXPECT_TRUE(leaper.update([](float, float) { return true; }));
    expectExactCover(leaper);
    EXPECT_EQ(leaper.boxes().size(), 3u * 2u * 2u); // one per region
}

TEST(SpaceLeaping, OnlyRegionsThatChangeAreMergedAnew)
{
    SpaceLeaper leaper;
    ASSERT_TRUE(leaper.setRanges(CELLS, ball()).ok());
    EXPECT_FALSE(leaper.update([](float, float) { return false; }));
    EXPECT_TRUE(leaper.update([](float low, float) { return low < 2.0f; })); // one region
    EXPECT_EQ(leaper.regionsMerged(), 1);
    EXPECT_FALSE(leaper.update([](float low, float) { return low < 2.0f; }));
    EXPECT_EQ(leaper.regionsMerged(), 0);
    EXPECT_TRUE(leaper.update([](float, float high) { return high > 15.0f; }));
    expectExactCover(leaper);
}

TEST(SpaceLeaping, VoxelBoxesAndTetrahedraFillTheSame)
{
    SpaceLeaper leaper;
    ASSERT_TRUE(leaper.setRanges(CELLS, ball()).ok());
    leaper.update([](float low, float) { return low < 9.0f; });
    // Cells of 8 voxels, the last ones cut at the extent.
    const Box3d extent{{0, 0, 0}, {36.0 * 8 + 3, 19.5 * 8, 17 * 8}};
    double boxes = 0.0;
    for (const Box3d& b : leaper.voxelBoxes(glm::ivec3(8), extent))
        boxes += b.size().x * b.size().y * b.size().z;
    const TetraSet set = leaper.tetraSet(glm::ivec3(8), extent);
    ASSERT_TRUE(set.validate().ok());
    EXPECT_NEAR(volume(set), boxes, 1e-9 * boxes);
    EXPECT_LE(boxes, 512.0 * double(leaper.occupiedCells()));
}

TEST(SpaceLeaping, RefusesBadRanges)
{
    SpaceLeaper leaper;
    EXPECT_EQ(leaper.setRanges({2, 2, 2}, std::vector<CellRange>(7)).code,
              ErrorCode::SIZE_MISMATCH);
    EXPECT_EQ(leaper.setRanges({0, 2, 2}, {}).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(leaper.setRanges({1 << 15, 1 << 15, 1 << 15}, {}).code, ErrorCode::TOO_LARGE);
    std::vector<CellRange> ranges(8);
    ranges[5].minimum = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(leaper.setRanges({2, 2, 2}, ranges).index, 5);
}

} // namespace SpaceLeapingTest
