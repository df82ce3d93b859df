#include <osgVolumizer/core/voxels/BrickLayout.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace BrickLayoutTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

TEST(BrickLayout, OneBrickHoldsASmallVolume)
{
    const Result<BrickLayout> layout = BrickLayout::create({10, 20, 1}, {64, 64, 64});
    ASSERT_TRUE(layout.ok());
    ASSERT_EQ(1, layout->brickCount());
    const BrickPlace place = layout->brick(0);
    EXPECT_EQ((Box3i{{0, 0, 0}, {10, 20, 1}}), place.samples);
    EXPECT_EQ((Box3d{{0, 0, -0.5}, {9, 19, 0.5}}), place.clipBox);
    EXPECT_EQ(place.clipBox, layout->extent());
}

TEST(BrickLayout, NeighboursShareOneSample)
{
    const Result<BrickLayout> layout = BrickLayout::create({9, 1, 1}, {5, 5, 5});
    ASSERT_TRUE(layout.ok());
    ASSERT_EQ(glm::ivec3(2, 1, 1), layout->count());
    EXPECT_EQ((Box3i{{0, 0, 0}, {5, 1, 1}}), layout->brick(0).samples);
    EXPECT_EQ((Box3i{{4, 0, 0}, {9, 1, 1}}), layout->brick(1).samples);
    EXPECT_EQ(4.0, layout->brick(0).clipBox.max.x);
    EXPECT_EQ(4.0, layout->brick(1).clipBox.min.x);
}

// Whatever the sizes: clip boxes tile the extent, every brick holds the samples that its filter
// needs in its clip box, and bricks stay within their size and the volume.
TEST(BrickLayout, ClipBoxesTileAndSamplesSuffice)
{
    std::mt19937 random(7);
    const PartialBricks rules[] = {PartialBricks::SHRINK_TO_FIT, PartialBricks::TRUNCATE,
                                   PartialBricks::AVERAGE_UP};
    for (int trial = 0; trial < 3000; ++trial) {
        const int overlap = static_cast<int>(random() % 6);
        const int size = 2 + static_cast<int>(random() % 60);
        const int brick = overlap + 1 + static_cast<int>(random() % 30);
        const PartialBricks rule = rules[random() % 3];
        const Result<BrickLayout> layout =
            BrickLayout::create({1, size, 1}, glm::ivec3(brick), overlap, rule);
        ASSERT_TRUE(layout.ok());
        const std::int64_t count = layout->brickCount();
        double end = 0.0;
        for (std::int64_t i = 0; i < count; ++i) {
            const BrickPlace place = layout->brick(i);
            const int first = place.samples.min.y, last = place.samples.max.y - 1;
            ASSERT_EQ(end, place.clipBox.min.y);
            end = place.clipBox.max.y;
            ASSERT_LE(place.clipBox.min.y, end);
            ASSERT_GE(first, 0);
            ASSERT_LT(last, size);
            ASSERT_LE(place.samples.size().y, std::min(brick, size));
            if (rule != PartialBricks::SHRINK_TO_FIT) {
                ASSERT_EQ(std::min(brick, size), place.samples.size().y);
            }
            // A filter that reaches (overlap-1)/2 samples beyond the cell it is evaluated in.
            if (overlap >= 1) {
                const int reach = (overlap - 1) / 2;
                if (i > 0) {
                    ASSERT_LE(first, place.clipBox.min.y - reach);
                }
                if (i + 1 < count) {
                    ASSERT_GE(last, end + reach);
                }
            }
        }
        ASSERT_EQ(end, layout->extent().max.y);
        if (rule != PartialBricks::TRUNCATE) {
            ASSERT_EQ(size - 1.0, end);
        } else {
            ASSERT_GT(end, size - 1.0 - brick);
        }
    }
}

TEST(BrickLayout, IndexAndCoordinatesAreInverse)
{
    const Result<BrickLayout> layout = BrickLayout::create({100, 70, 50}, {10, 10, 10});
    ASSERT_TRUE(layout.ok());
    for (std::int64_t i = 0; i < layout->brickCount(); ++i)
        ASSERT_EQ(i, layout->index(layout->coordinates(i)));
}

TEST(BrickLayout, RefusesTooManyBricks)
{
    // 1.3 million bricks of a scan of a head, and fewer that are as good.
    const Status many = BrickLayout::create({128, 128, 84}, {2, 2, 2}).status;
    EXPECT_EQ(ErrorCode::TOO_LARGE, many.code);
    EXPECT_NE(std::string::npos, many.text.find("1338707 bricks")) << many.text;
    EXPECT_TRUE(BrickLayout::create({128, 128, 84}, {4, 4, 4}).ok());
    EXPECT_TRUE(BrickLayout::create({1024, 1024, 1024}, {32, 32, 32}, 3).ok());
    EXPECT_TRUE(BrickLayout::create({4000, 4000, 4000}, {64, 64, 64}, 1).ok());
    EXPECT_TRUE(BrickLayout::create({32000, 32000, 32000}, {512, 512, 512}, 5).ok());
}

TEST(BrickLayout, RefusesBricksThatShareNearlyEverything)
{
    const Status shared = BrickLayout::create({128, 128, 84}, {64, 64, 64}, 63).status;
    EXPECT_EQ(ErrorCode::TOO_LARGE, shared.code);
    EXPECT_NE(std::string::npos, shared.text.find("overlap 63")) << shared.text;
    EXPECT_FALSE(BrickLayout::create({512, 512, 512}, {64, 64, 64}, 50).ok());
    // Cubic, lit, in the smallest bricks that make sense.
    EXPECT_TRUE(BrickLayout::create({1024, 1024, 1024}, {32, 32, 32}, 5).ok());
    EXPECT_TRUE(BrickLayout::create({512, 512, 512}, {16, 16, 16}, 5).ok());
    // A small volume may be cut in any way.
    EXPECT_TRUE(BrickLayout::create({20, 20, 20}, {8, 8, 8}, 7).ok());
}

// Neither bound is off where the product of three axes has more bits than an integer.
TEST(BrickLayout, RefusesWhatOverflows)
{
    const int huge = 2147483647;
    for (const int brick : {2, 1000, huge - 1})
        for (const int overlap : {1, brick - 1}) {
            const Result<BrickLayout> layout =
                BrickLayout::create({huge, huge, huge}, glm::ivec3(brick), overlap);
            EXPECT_EQ(layout.ok(), brick == huge - 1) << brick << " " << overlap;
        }
    EXPECT_TRUE(BrickLayout::create({huge, huge, huge}, glm::ivec3(huge)).ok());
}

TEST(BrickLayout, RefusesWhatHasNoMeaning)
{
    EXPECT_EQ(ErrorCode::VALUE_INVALID, BrickLayout::create({8, 0, 8}, {4, 4, 4}).status.code);
    EXPECT_EQ(1, BrickLayout::create({8, 0, 8}, {4, 4, 4}).status.index);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, BrickLayout::create({8, 8, 8}, {4, 4, 1}).status.code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, BrickLayout::create({8, 8, 8}, {4, 4, 4}, -1).status.code);
    EXPECT_EQ(
        ErrorCode::VALUE_INVALID,
        BrickLayout::create({8, 8, 8}, {4, 4, 4}, 1, static_cast<PartialBricks>(9)).status.code);
    const int huge = 2147483647;
    EXPECT_EQ(ErrorCode::TOO_LARGE, BrickLayout::create({huge, huge, huge}, {2, 2, 2}).status.code);
}

TEST(BrickLayout, FindsTheBrickOfAPosition)
{
    for (const int overlap : {0, 1, 2, 3, 5})
        for (const PartialBricks partial :
             {PartialBricks::SHRINK_TO_FIT, PartialBricks::TRUNCATE, PartialBricks::AVERAGE_UP}) {
            const BrickLayout layout =
                *BrickLayout::create({50, 7, 23}, {9, 7, 8}, overlap, partial);
            for (std::int64_t i = 0; i < layout.brickCount(); ++i) {
                const Box3d box = layout.brick(i).clipBox;
                EXPECT_EQ(layout.brickAt(box.min), i); // half-open
                EXPECT_EQ(layout.brickAt(box.center()), i);
                glm::dvec3 last;
                for (int axis = 0; axis < 3; ++axis)
                    last[axis] = std::nextafter(box.max[axis], 0.0);
                EXPECT_EQ(layout.brickAt(last), i);
            }
            const Box3d all = layout.extent();
            EXPECT_EQ(layout.brickAt(all.max), layout.brickCount() - 1);
            EXPECT_EQ(layout.brickAt(all.max + glm::dvec3(1e-9, 0, 0)), -1);
            EXPECT_EQ(layout.brickAt(all.min - glm::dvec3(0, 1e-9, 0)), -1);
            EXPECT_EQ(layout.brickAt({NAN, 1, 1}), -1);
        }
    EXPECT_EQ(BrickLayout().brickAt(glm::dvec3(0.0)), -1);
}

TEST(BrickLayout, ASliceIsAsThickAsTheDistanceToANextOne)
{
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 size(20);
        size[axis] = 1;
        const BrickLayout layout = *BrickLayout::create(size, glm::ivec3(8), 1);
        EXPECT_EQ(layout.extent().min[axis], -0.5);
        EXPECT_EQ(layout.extent().max[axis], 0.5);
        EXPECT_EQ(layout.extent().max[(axis + 1) % 3], 19.0);
        double volume = 0.0;
        for (std::int64_t i = 0; i < layout.brickCount(); ++i) {
            const glm::dvec3 s = layout.brick(i).clipBox.size();
            volume += s.x * s.y * s.z;
            EXPECT_EQ(layout.brick(i).samples.size()[axis], 1);
            EXPECT_EQ(layout.brickAt(layout.brick(i).clipBox.center()), i);
        }
        EXPECT_NEAR(volume, 19.0 * 19.0, 1e-9);
    }
}

} // namespace BrickLayoutTest
