#include "osgVolumizer/core/ordering/BrickOrder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

namespace BrickOrderTest {

using namespace osgVolumizer::core;

namespace {

const std::vector<double> X{0.0, 3.0, 4.0, 9.0}, Y{0.0, 5.0, 6.5}, Z{-1.0, 0.0, 2.0, 3.0, 7.0};

std::vector<std::int64_t> allBricks()
{
    std::vector<std::int64_t> bricks(3 * 2 * 4);
    std::iota(bricks.begin(), bricks.end(), 0);
    return bricks;
}

int cellOf(const std::vector<double>& splits, double v)
{
    return static_cast<int>(std::upper_bound(splits.begin(), splits.end(), v) - splits.begin()) - 1;
}

/// Walks a ray from the eye and expects the bricks it meets to come later and later in the list the
/// nearer they are.
void expectOrder(const glm::dvec4& eye, const glm::dvec3& start, const glm::dvec3& direction,
                 const std::vector<std::int64_t>& sorted)
{
    std::map<std::int64_t, int> place;
    for (std::size_t i = 0; i < sorted.size(); ++i)
        place[sorted[i]] = static_cast<int>(i);
    int last = static_cast<int>(sorted.size());
    for (double t = 0.0; t < 60.0; t += 0.013) {
        const glm::dvec3 p = start + t * direction;
        const int x = cellOf(X, p.x), y = cellOf(Y, p.y), z = cellOf(Z, p.z);
        if (x < 0 || y < 0 || z < 0 || x > 2 || y > 1 || z > 3) continue;
        const int here = place.at(x + 3 * (y + 2 * z));
        ASSERT_LE(here, last) << eye.x << " " << eye.y << " " << eye.z;
        last = here;
    }
}

} // namespace

TEST(BrickOrder, EveryRayMeetsBricksInOrderAlsoFromInside)
{
    const BrickOrder order(X, Y, Z);
    EXPECT_EQ(order.count(), glm::ivec3(3, 2, 4));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-4.0, 12.0), d(-1.0, 1.0);
    for (int i = 0; i < 300; ++i) {
        glm::dvec3 eye(u(random), u(random), u(random));
        if (i % 5 == 0) eye = {3.0, 5.0, 0.0}; // exactly on the splits
        std::vector<std::int64_t> bricks = allBricks();
        order.sort({2.0 * eye, 2.0}, bricks);
        for (int k = 0; k < 10; ++k)
            expectOrder({eye, 1.0}, eye, {d(random), d(random), d(random)}, bricks);
    }
}

TEST(BrickOrder, ParallelProjection)
{
    const BrickOrder order(X, Y, Z);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> u(0.0, 7.0), d(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        glm::dvec3 towards(d(random), d(random), d(random));
        if (i % 4 == 0) towards[i / 4 % 3] = 0.0;
        std::vector<std::int64_t> bricks = allBricks();
        order.sort({towards, 0.0}, bricks);
        for (int k = 0; k < 10; ++k) {
            const glm::dvec3 inside(u(random), u(random), u(random));
            expectOrder({towards, 0.0}, inside + 20.0 * towards, -towards, bricks);
        }
    }
}

TEST(BrickOrder, SortsASubset)
{
    const BrickOrder order(X, Y, Z);
    std::vector<std::int64_t> bricks{5, 23, 0};
    order.sort({-10.0, -10.0, -10.0, 1.0}, bricks);
    EXPECT_EQ(bricks, (std::vector<std::int64_t>{23, 5, 0}));
}

} // namespace BrickOrderTest
