#include <osgVolumizer/render/merge/ScreenAreas.h>

#include <gtest/gtest.h>

#include <random>

namespace ScreenAreasTest {

using namespace osgVolumizer;
using namespace osgVolumizer::render;

namespace {

constexpr int SIZE = 16;

bool covers(const glm::ivec4& r, int x, int y)
{
    return x >= r[0] && x < r[0] + r[2] && y >= r[1] && y < r[1] + r[3];
}

int timesCovered(const std::vector<glm::ivec4>& rectangles, int x, int y)
{
    int count = 0;
    for (const glm::ivec4& r : rectangles)
        count += covers(r, x, y);
    return count;
}

class Rectangles
{
public:
    glm::ivec4 next()
    {
        const int x = at(0, SIZE - 1), y = at(0, SIZE - 1);
        return {x, y, at(1, SIZE - x), at(1, SIZE - y)};
    }

private:
    int at(int low, int high) { return std::uniform_int_distribution<int>(low, high)(_random); }

    std::mt19937 _random{7};
};

ScreenArea area(const glm::ivec4& rectangle, std::size_t member)
{
    return {rectangle, {member}};
}

} // namespace

TEST(ScreenAreas, SubtractLeavesEveryOtherPixelOnce)
{
    Rectangles random;
    for (int round = 0; round < 200; ++round) {
        std::vector<glm::ivec4> left{{0, 0, SIZE, SIZE}}, holes;
        for (int i = 0; i < 4; ++i) {
            holes.push_back(random.next());
            left = subtract(left, holes.back());
            for (int y = 0; y < SIZE; ++y)
                for (int x = 0; x < SIZE; ++x)
                    ASSERT_EQ(timesCovered(left, x, y), timesCovered(holes, x, y) ? 0 : 1)
                        << "round " << round << " at " << x << " " << y;
        }
        for (const glm::ivec4& r : left)
            EXPECT_TRUE(r[2] > 0 && r[3] > 0);
    }
}

TEST(ScreenAreas, SubtractOfAllLeavesNothingAndOfNothingLeavesAll)
{
    const std::vector<glm::ivec4> one{{3, 4, 5, 6}};
    EXPECT_TRUE(subtract(one, {3, 4, 5, 6}).empty());
    EXPECT_TRUE(subtract(one, {0, 0, 20, 20}).empty());
    EXPECT_EQ(subtract(one, {8, 4, 5, 6}), one); // beside it
    EXPECT_EQ(subtract(one, {3, 10, 5, 6}), one);
    EXPECT_TRUE(subtract({}, {0, 0, 1, 1}).empty());
}

TEST(ScreenAreas, JoinedAreasAreDisjointAndKeepTheirMembers)
{
    Rectangles random;
    for (int round = 0; round < 200; ++round) {
        std::vector<ScreenArea> areas;
        for (std::size_t i = 0; i < 6; ++i) {
            const glm::ivec4 r = random.next();
            areas.push_back(area({r[0], r[1], (r[2] + 2) / 3, (r[3] + 2) / 3}, i));
        }
        const std::vector<ScreenArea> joined = joinOverlapping(areas, 8);
        std::vector<glm::ivec4> rectangles;
        std::vector<int> owner(6, -1);
        for (const ScreenArea& j : joined) {
            rectangles.push_back(j.rectangle);
            for (const std::size_t member : j.members) {
                EXPECT_EQ(owner[member], -1);
                owner[member] = static_cast<int>(rectangles.size()) - 1;
            }
        }
        for (int y = 0; y < SIZE; ++y)
            for (int x = 0; x < SIZE; ++x)
                ASSERT_LE(timesCovered(rectangles, x, y), 1) << "round " << round;
        for (std::size_t i = 0; i < 6; ++i) {
            ASSERT_GE(owner[i], 0);
            const glm::ivec4 in = areas[i].rectangle;
            const glm::ivec4 out = rectangles[static_cast<std::size_t>(owner[i])];
            EXPECT_TRUE(covers(out, in[0], in[1]) &&
                        covers(out, in[0] + in[2] - 1, in[1] + in[3] - 1));
        }
    }
}

TEST(ScreenAreas, WhatTouchesWithoutAPixelInCommonIsNotJoined)
{
    const auto joined = joinOverlapping({area({0, 0, 4, 4}, 0), area({4, 0, 4, 4}, 1)}, 8);
    EXPECT_EQ(joined.size(), 2u);
}

TEST(ScreenAreas, ManyBecomeOneAndEmptyOnesGo)
{
    std::vector<ScreenArea> areas{area({5, 5, 0, 3}, 9)};
    for (std::size_t i = 0; i < 4; ++i)
        areas.push_back(area({int(3 * i), int(3 * i), 2, 1}, i));
    EXPECT_EQ(joinOverlapping(areas, 4).size(), 4u);
    const auto joined = joinOverlapping(areas, 3);
    ASSERT_EQ(joined.size(), 1u);
    EXPECT_EQ(joined[0].rectangle, glm::ivec4(0, 0, 11, 10));
    EXPECT_EQ(joined[0].members, (std::vector<std::size_t>{0, 1, 2, 3}));
    EXPECT_TRUE(joinOverlapping({area({5, 5, 0, 3}, 9)}, 3).empty());
}

TEST(ScreenAreas, PixelsOfDeviceCoordinates)
{
    const glm::ivec4 viewport(10, 20, 100, 50);
    EXPECT_EQ(pixelRectangle({glm::dvec2(-1), glm::dvec2(1)}, viewport, 0), viewport);
    EXPECT_EQ(pixelRectangle({glm::dvec2(-1), glm::dvec2(1)}, viewport, 3), viewport);
    EXPECT_EQ(pixelRectangle({glm::dvec2(-1e300), glm::dvec2(1e300)}, viewport, 0), viewport);
    // Rounded outwards, to whole pixels.
    EXPECT_EQ(pixelRectangle({{-0.5, 0.0}, {0.01, 0.02}}, viewport, 0),
              glm::ivec4(10 + 25, 20 + 25, 26, 1));
    EXPECT_EQ(pixelRectangle({{-0.5, 0.0}, {0.0, 0.04}}, viewport, 2),
              glm::ivec4(10 + 23, 20 + 23, 29, 5));
}

TEST(ScreenAreas, OutsideTheViewportThereAreNoPixels)
{
    const glm::ivec4 viewport(10, 20, 100, 50);
    for (const ScreenRectangle& outside :
         {ScreenRectangle{{1.1, -1.0}, {2.0, 1.0}}, ScreenRectangle{{-3.0, -1.0}, {-1.1, 1.0}},
          ScreenRectangle{{-1.0, 1.2}, {1.0, 9.0}}, ScreenRectangle{{-1.0, -9.0}, {1.0, -1.2}}}) {
        const glm::ivec4 r = pixelRectangle(outside, viewport, 0);
        EXPECT_TRUE(r[2] == 0 || r[3] == 0) << r[0] << " " << r[1] << " " << r[2] << " " << r[3];
        EXPECT_TRUE(r[2] >= 0 && r[3] >= 0);
    }
}

} // namespace ScreenAreasTest
