// How many slots surfaces get for their fragments.
#include <osgVolumizer/render/merge/captured/CaptureSlots.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace CaptureSlotsTest {

using namespace osgVolumizer::render;

namespace {

SurfaceDepthComplexity mesh(double estimate, std::size_t triangles)
{
    return {estimate, triangles, true};
}

int slotsOf(const std::vector<CaptureSet>& sets)
{
    int sum = 0;
    for (const CaptureSet& set : sets)
        sum += set.slotCount;
    return sum;
}

// Sets follow each other without gaps, fill whole fours, and have each surface once.
void expectWhole(const std::vector<CaptureSet>& sets, std::size_t surfaceCount)
{
    int next = 0;
    std::multiset<std::size_t> surfaces;
    for (const CaptureSet& set : sets) {
        EXPECT_EQ(set.firstSlot, next);
        EXPECT_GT(set.slotCount, 0);
        next += set.slotCount;
        surfaces.insert(set.surfaces.begin(), set.surfaces.end());
    }
    EXPECT_EQ(next % 4, 0);
    EXPECT_EQ(surfaces.size(), surfaceCount);
    for (std::size_t s = 0; s < surfaceCount; ++s)
        EXPECT_EQ(surfaces.count(s), 1u) << s;
}

} // namespace

TEST(CaptureSlots, SmallMeshesShareASet)
{
    const auto sets = findCaptureSets({mesh(1.0, 2), mesh(1.0, 2), mesh(2.0, 500)}, 24);
    ASSERT_EQ(sets.size(), 1u);
    expectWhole(sets, 3);
    // One more than the estimate of each, but never more than it has triangles: 2 + 2 + 3.
    EXPECT_EQ(slotsOf(sets), 8);
}

TEST(CaptureSlots, LargeMeshesHaveSetsOfTheirOwn)
{
    const auto sets = findCaptureSets({mesh(2.0, 10000), mesh(1.0, 2), mesh(3.0, 10000)}, 24);
    ASSERT_EQ(sets.size(), 3u);
    expectWhole(sets, 3);
    EXPECT_EQ(sets[0].surfaces, std::vector<std::size_t>{1});
    EXPECT_EQ(sets[1].surfaces, std::vector<std::size_t>{0});
    // With one to spare, where there is room.
    EXPECT_EQ(sets[0].slotCount, 2);
    EXPECT_EQ(sets[1].slotCount, 3);
    EXPECT_GE(sets[2].slotCount, 4);
}

TEST(CaptureSlots, AreNoMoreThanCanBeAfforded)
{
    const std::vector<SurfaceDepthComplexity> surfaces = {mesh(5.0, 10000), mesh(4.0, 10000),
                                                          mesh(2.0, 100)};
    for (int affordable = 0; affordable <= 24; affordable += 4) {
        const auto sets = findCaptureSets(surfaces, affordable);
        // 5 and 4 estimated, which is 0.9 of it rounded up; 3 for the small one.
        EXPECT_EQ(sets.empty(), affordable < 12) << affordable;
        EXPECT_LE(slotsOf(sets), affordable);
        if (!sets.empty()) expectWhole(sets, 3);
    }
}

TEST(CaptureSlots, UnknownSurfacesGetAGuess)
{
    const auto sets = findCaptureSets({SurfaceDepthComplexity()}, 24);
    ASSERT_EQ(sets.size(), 1u);
    EXPECT_EQ(slotsOf(sets), 4);
    EXPECT_TRUE(findCaptureSets({SurfaceDepthComplexity()}, 0).empty());
}

TEST(CaptureSlots, NothingNeedsNone)
{
    EXPECT_TRUE(findCaptureSets({}, 24).empty());
}

// Estimates that are no numbers, or beyond all bounds, ask for no more than there is.
TEST(CaptureSlots, SurviveAnyEstimate)
{
    EXPECT_TRUE(findCaptureSets({mesh(1e300, 1000000)}, 24).empty());
    expectWhole(findCaptureSets({mesh(0.0, 1000000)}, 24), 1);
}

TEST(CaptureSlots, FitIntoMemory)
{
    EXPECT_EQ(affordableSlots(64, 64), 24);
    EXPECT_EQ(affordableSlots(0, 0), 24);
    EXPECT_LT(affordableSlots(3840, 2160), 24);
    EXPECT_EQ(affordableSlots(3840, 2160) % 4, 0);
    EXPECT_EQ(affordableSlots(30000, 30000), 0);
    for (int size = 64; size < 40000; size *= 2)
        EXPECT_LE(double(affordableSlots(size, size)) * size * size * 25, 512.0 * 1024 * 1024);
}

} // namespace CaptureSlotsTest
