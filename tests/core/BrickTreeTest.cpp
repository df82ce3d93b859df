#include <osgVolumizer/core/voxels/BrickTree.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace BrickTreeTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

const glm::dvec4 FROM_Z(0.0, 0.0, 1.0, 0.0);

BrickTree treeOf(const glm::ivec3& size, int step, int overlap = 1)
{
    const auto tree = BrickTree::create(size, BrickTree::levelsFor(size, step), step, overlap);
    EXPECT_TRUE(tree.ok()) << tree.status.text;
    return *tree;
}

double volumeOf(const Box3d& box)
{
    const glm::dvec3 s = box.size();
    return s.x * s.y * s.z;
}

TEST(BrickTree, LevelsHalveUntilOneBrickIsLeft)
{
    const BrickTree tree = treeOf({1000, 257, 3}, 64);
    EXPECT_EQ(tree.levelCount(), 5);
    EXPECT_EQ(BrickTree::levelSize({1000, 257, 3}, 1), glm::ivec3(500, 129, 2));
    EXPECT_EQ(BrickTree::levelSize({1000, 257, 3}, 4), glm::ivec3(63, 17, 1));
    EXPECT_EQ(tree.count(0), glm::ivec3(16, 4, 1));
    EXPECT_EQ(tree.count(4), glm::ivec3(1));
    EXPECT_EQ(tree.roots(FROM_Z).size(), 1u);
    EXPECT_EQ(BrickTree::levelsFor(glm::ivec3(65), 64), 1);
    EXPECT_EQ(BrickTree::levelsFor(glm::ivec3(66), 64), 2);
}

TEST(BrickTree, ChildrenTileTheirParentExactly)
{
    for (const glm::ivec3& size : {glm::ivec3(130, 67, 1), {9, 100, 33}, {2, 2, 2}, {65, 65, 65}}) {
        const BrickTree tree = treeOf(size, 8);
        double all = 0.0;
        for (std::int64_t i = 0; i < tree.brickCount(); ++i) {
            const TreeBrick brick = tree.brick(i);
            EXPECT_EQ(tree.index(brick.level, brick.coordinates), i);
            if (brick.level == 0) {
                all += volumeOf(brick.clipBox);
                EXPECT_TRUE(tree.children(i, FROM_Z).empty());
                continue;
            }
            Box3d sum;
            double volume = 0.0;
            for (const std::int64_t child : tree.children(i, FROM_Z)) {
                sum.expand(tree.brick(child).clipBox.min);
                sum.expand(tree.brick(child).clipBox.max);
                volume += volumeOf(tree.brick(child).clipBox);
            }
            EXPECT_EQ(sum, brick.clipBox);
            EXPECT_NEAR(volume, volumeOf(brick.clipBox), 1e-9 * volume);
        }
        const glm::dvec3 extent = glm::max(glm::dvec3(size - 1), glm::dvec3(1.0));
        EXPECT_NEAR(all, extent.x * extent.y * extent.z, 1e-9 * all);
    }
}

// Wherever a filter of the support that the overlap is for looks within the clip box, the brick has
// the sample, or there is none.
TEST(BrickTree, BricksHoldWhatTheirFilterNeeds)
{
    for (const int overlap : {1, 3, 5}) {
        const BrickTree tree = treeOf({75, 40, 21}, 8, overlap);
        const int reach = (overlap - 1) / 2;
        for (std::int64_t i = 0; i < tree.brickCount(); ++i) {
            const TreeBrick brick = tree.brick(i);
            const glm::ivec3 size = BrickTree::levelSize(tree.size(), brick.level);
            for (int axis = 0; axis < 3; ++axis)
                for (const double end : {brick.clipBox.min[axis], brick.clipBox.max[axis]}) {
                    const double at = (end - brick.offset) / brick.spacing;
                    const int low = std::max(int(std::floor(at)) - reach, 0);
                    const int high = std::min(int(std::ceil(at)) + reach, size[axis] - 1);
                    EXPECT_LE(brick.samples.min[axis], low);
                    EXPECT_GT(brick.samples.max[axis], std::min(high, size[axis] - 1));
                }
        }
    }
}

// Sample i of a level is the mean of the samples at and beside its place: a ramp stays itself.
TEST(BrickTree, SamplesLieWhereTheMeanOfThoseBelowLies)
{
    const BrickTree tree = treeOf(glm::ivec3(256), 16);
    for (int level = 0; level < tree.levelCount(); ++level) {
        const TreeBrick brick = tree.brick(tree.index(level, glm::ivec3(0)));
        double mean = 0.0; // of the positions 3 * 2^l ... 4 * 2^l - 1
        const int spacing = 1 << level;
        for (int k = 0; k < spacing; ++k)
            mean += double(3 * spacing + k) / spacing;
        EXPECT_DOUBLE_EQ(brick.spacing * 3.0 + brick.offset, mean);
    }
}

// Along any ray from the eye, what lies further away comes first.
TEST(BrickTree, ChildrenAreOrderedFarToNear)
{
    const BrickTree tree = treeOf({64, 50, 41}, 8);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-40.0, 100.0), direction(-1.0, 1.0);
    for (int round = 0; round < 200; ++round) {
        const glm::dvec3 eye(place(random), place(random), place(random));
        const glm::dvec3 way =
            glm::normalize(glm::dvec3(direction(random), direction(random), direction(random)));
        std::vector<std::int64_t> order, stack = tree.roots({eye, 1.0});
        std::reverse(stack.begin(), stack.end());
        while (!stack.empty()) {
            const std::int64_t next = stack.back();
            stack.pop_back();
            auto children = tree.children(next, {eye, 1.0});
            if (children.empty()) order.push_back(next);
            stack.insert(stack.end(), children.rbegin(), children.rend());
        }
        EXPECT_EQ(std::int64_t(order.size()), tree.brickCount(0));
        double before = 1e9; // where the ray enters the brick that it met last
        for (const std::int64_t brick : order) {
            const Box3d box = tree.brick(brick).clipBox;
            double enter = 0.0, leave = 1e9;
            for (int axis = 0; axis < 3; ++axis) {
                const double a = (box.min[axis] - eye[axis]) / way[axis];
                const double b = (box.max[axis] - eye[axis]) / way[axis];
                enter = std::max(enter, std::min(a, b));
                leave = std::min(leave, std::max(a, b));
            }
            if (!(enter + 1e-9 < leave)) continue;
            EXPECT_LE(enter, before + 1e-9);
            before = enter;
        }
    }
}

TEST(BrickTree, RefusesWhatMakesNone)
{
    EXPECT_EQ(BrickTree::create({0, 4, 4}, 1, 8).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(BrickTree::create({4, 4, 4}, 0, 8).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(BrickTree::create({4, 4, 4}, 25, 8).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(BrickTree::create({4, 4, 4}, 1, 0).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(BrickTree::create({4, 4, 4}, 1, 8, 0).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(BrickTree::create(glm::ivec3(2000000000), 1, 1).status.code, ErrorCode::TOO_LARGE);
    EXPECT_EQ(BrickTree().levelCount(), 0);
    EXPECT_TRUE(BrickTree().roots(FROM_Z).empty());
}

} // namespace BrickTreeTest
