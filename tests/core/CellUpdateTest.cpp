// Ranges of cells and layers that are found again where samples have changed, against those of all
// samples.
#include <osgVolumizer/core/voxels/LayerRanges.h>
#include <osgVolumizer/core/voxels/Occupancy.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace CellUpdateTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

const Box3i BRICK{{5, -3, 40}, {46, 30, 59}};

void expectSame(const LayerRanges& a, const LayerRanges& b)
{
    for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(a.axis[axis].size(), b.axis[axis].size());
        for (std::size_t i = 0; i < a.axis[axis].size(); ++i) {
            EXPECT_EQ(a.axis[axis][i].low, b.axis[axis][i].low) << axis << " " << i;
            EXPECT_EQ(a.axis[axis][i].high, b.axis[axis][i].high) << axis << " " << i;
        }
    }
}

void expectSame(const CellGrid& a, const CellGrid& b)
{
    EXPECT_EQ(a.low, b.low);
    EXPECT_EQ(a.high, b.high);
}

} // namespace

TEST(CellUpdate, RangesAreThoseOfAllSamples)
{
    std::mt19937 random(11);
    const auto pick = [&random](int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random);
    };
    const glm::ivec3 size = BRICK.size();
    std::vector<float> samples(std::size_t(sampleCount(size)));
    for (float& v : samples)
        v = 0.001f * float(pick(0, 1000));
    const VoxelView view{samples.data(), VoxelType::FLOAT32, 1, size};
    const auto scan = [&](FilterSupport support) {
        return scanCells(view, 8, glm::dvec3(BRICK.min), support);
    };
    CellGrid linear = scan(FilterSupport::LINEAR), cubic = scan(FilterSupport::CUBIC);
    LayerRanges layers = scanLayers(view);
    double looked = 0.0, changedLayers = 0.0;
    const auto rangeOf = [&](const Box3i& box) {
        looked += 1.0;
        return scanRange(view, {box.min - BRICK.min, box.max - BRICK.min});
    };
    for (int round = 0; round < 60; ++round) {
        std::vector<Box3i> changed;
        for (int i = pick(1, 3); i > 0; --i) {
            Box3i box;
            for (int a = 0; a < 3; ++a) {
                box.min[a] = pick(BRICK.min[a], BRICK.max[a] - 1);
                box.max[a] = std::min(box.min[a] + pick(1, 6), BRICK.max[a]);
                changedLayers += box.size()[a];
            }
            changed.push_back(box);
            // Beyond all, back to what others have, or no value.
            const int kind = pick(0, 3);
            const float value = kind == 0   ? 2.0f + float(round)
                                : kind == 1 ? -1.0f - float(round)
                                : kind == 2 ? 0.5f
                                            : std::numeric_limits<float>::quiet_NaN();
            for (int z = box.min.z; z < box.max.z; ++z)
                for (int y = box.min.y; y < box.max.y; ++y)
                    for (int x = box.min.x; x < box.max.x; ++x) {
                        const glm::ivec3 p = glm::ivec3(x, y, z) - BRICK.min;
                        samples[std::size_t(p.x + size.x * (p.y + size.y * p.z))] = value;
                    }
        }
        for (auto* grid : {&linear, &cubic}) {
            const auto support = grid == &linear ? FilterSupport::LINEAR : FilterSupport::CUBIC;
            for (const std::size_t cell : cellsTouching(*grid, support, changed))
                setCellRange(*grid, cell, rangeOf(cellSamples(*grid, cell, support, BRICK)));
        }
        expectSame(linear, scan(FilterSupport::LINEAR));
        expectSame(cubic, scan(FilterSupport::CUBIC));
        LayerRanges byCubic = layers;
        looked = 0.0;
        changedLayers = 0.0;
        for (const Box3i& box : changed)
            changedLayers += box.size().x + box.size().y + box.size().z;
        rescanLayers(layers, linear, BRICK, changed, rangeOf);
        EXPECT_LE(looked, changedLayers * 20.0); // of up to 24 cells, twice
        rescanLayers(byCubic, cubic, BRICK, changed, rangeOf);
        expectSame(layers, scanLayers(view));
        expectSame(byCubic, layers);
    }
}

// Where most is the same, few cells are looked at.
TEST(CellUpdate, FewCellsTellTheRangeOfALayer)
{
    const Box3i brick{glm::ivec3(0), glm::ivec3(65)};
    std::vector<unsigned char> samples(65 * 65 * 65, 0);
    const VoxelView view{samples.data(), VoxelType::UINT8, 1, brick.size()};
    CellGrid grid = scanCells(view, 8);
    LayerRanges layers = scanLayers(view);
    const Box3i box{{20, 20, 20}, {24, 24, 24}};
    for (int z = 20; z < 24; ++z)
        for (int y = 20; y < 24; ++y)
            for (int x = 20; x < 24; ++x)
                samples[std::size_t(x + 65 * (y + 65 * z))] = 200;
    int looked = 0;
    const auto rangeOf = [&](const Box3i& part) {
        ++looked;
        return scanRange(view, part);
    };
    const auto cells = cellsTouching(grid, FilterSupport::LINEAR, {box});
    EXPECT_EQ(cells.size(), 1u); // 16 to 24
    for (const std::size_t cell : cells)
        setCellRange(grid, cell, rangeOf(cellSamples(grid, cell, FilterSupport::LINEAR, brick)));
    rescanLayers(layers, grid, brick, {box}, rangeOf);
    EXPECT_LE(looked, 1 + 2 * 12);
    EXPECT_EQ(layers.axis[1][22].high, 200.0);
    EXPECT_EQ(layers.axis[1][22].low, 0.0);
    EXPECT_EQ(layers.axis[1][24].high, 0.0);
}

} // namespace CellUpdateTest
