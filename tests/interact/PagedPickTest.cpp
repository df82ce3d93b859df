// Picks of voxels that are paged, and of time steps.
#include "PickOracle.h"

#include <render/PagedScene.h>

#include <osg/FrameStamp>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

namespace PagedPickTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using paged::FormulaSource;
using paged::readsOf;

namespace {

constexpr int SIZE = 64;
const Points SURFACE = {{0.5, {1, 1, 1, 0.0}}, {0.6, {1, 1, 1, 0.9}}};

double blob(const glm::dvec3& p)
{
    return std::exp(-0.5 * glm::dot(p - 31.5, p - 31.5) / 150.0);
}

osg::ref_ptr<VolumeAppearance> volumeOf(FormulaSource* source)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    voxels->setRange({0.0, 1.0});
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setLookupTable(makeTable(SURFACE));
    return appearance;
}

TEST(PagedPick, ReadsTheFinestPagesAlongTheLine)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, blob);
    const auto appearance = volumeOf(source);
    const auto whole = makeVoxels(glm::ivec3(SIZE), blob);
    osg::ref_ptr<VolumeAppearance> twin = makeVolume(whole);
    twin->setLookupTable(makeTable(SURFACE));
    const int before = source->reads[0];
    RandomLines lines(glm::dvec3(0.0), glm::dvec3(SIZE - 1));
    int hits = 0;
    for (int i = 0; i < 200; ++i) {
        const Line line = lines.next();
        const auto found = pickLine(*appearance, line), expected = pickLine(*twin, line);
        ASSERT_EQ(found.has_value(), expected.has_value());
        if (!found) continue;
        ++hits;
        EXPECT_EQ(found->level, 0);
        EXPECT_NEAR(found->ratio, expected->ratio, 1e-6);
    }
    EXPECT_GT(hits, 20);
    // None is read twice.
    EXPECT_LE(source->reads[0] - before, appearance->getVoxels()->getTree().brickCount(0));
}

TEST(PagedPick, TakesACoarserLevelWithinItsBytes)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, blob);
    const auto appearance = volumeOf(source);
    const std::int64_t page = 17 * 17 * 17 * 4;
    PickOptions options;
    double exact = 0.0;
    int level = 0;
    for (const std::int64_t pages : {100, 2, 1, 0}) {
        options.maximumBytes = pages * page;
        const auto found = pickVolume(geometryBelow(*appearance), *appearance, {31.0, 30.0, -50.0},
                                      {31.0, 30.0, 150.0}, options);
        ASSERT_TRUE(found.ok() && found->has_value());
        EXPECT_GE((*found)->level, level);
        level = (*found)->level;
        if (level == 0) exact = (*found)->point.z();
        EXPECT_NEAR((*found)->point.z(), exact, 0.3 * (1 << level));
    }
    EXPECT_GE(level, 2);
}

TEST(PagedPick, SkipsPagesThatTheSourceKnowsToBeEmpty)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, blob);
    source->range = [](int level, const core::Box3i& region) {
        const double s = 1 << level;
        glm::dvec3 nearest =
            glm::clamp(glm::dvec3(31.5), s * glm::dvec3(region.min), s * glm::dvec3(region.max));
        return std::optional(std::make_pair(0.0, blob(nearest) + 0.01));
    };
    const auto appearance = volumeOf(source);
    const std::int64_t before = readsOf(*source);
    EXPECT_FALSE(pickLine(*appearance, {{2, 2, -50}, {2, 2, 150}}).has_value());
    EXPECT_EQ(readsOf(*source), before);
}

// Pages of holes only are no failure.
TEST(PagedPick, SeesThroughPagesOfHoles)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource(
        SIZE, [](const glm::dvec3& p) { return p.z < 17.5 ? std::nan("") : blob(p); });
    const auto found = pickLine(*volumeOf(source), {{31.0, 30.0, -50.0}, {31.0, 30.0, 150.0}});
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->level, 0);
    const auto whole =
        pickLine(*volumeOf(osg::ref_ptr<FormulaSource>(new FormulaSource(SIZE, blob))),
                 {{31.0, 30.0, -50.0}, {31.0, 30.0, 150.0}});
    ASSERT_TRUE(whole.has_value());
    // A little of what shows lies in the holes.
    EXPECT_NEAR(found->point.z(), whole->point.z(), 0.2);
}

// What failed once is asked for again.
TEST(PagedPick, SeesTheFinestOnceTheDiskIsBack)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, blob);
    const auto appearance = volumeOf(source);
    source->failBelow = 1;
    ASSERT_EQ(pickLine(*appearance, {{31.0, 30.0, -50.0}, {31.0, 30.0, 150.0}})->level, 1);
    source->failBelow = 0;
    EXPECT_EQ(pickLine(*appearance, {{31.0, 30.0, -50.0}, {31.0, 30.0, 150.0}})->level, 0);
}

TEST(PagedPick, SeesCoarserPagesWhereADiskFails)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, blob);
    const auto appearance = volumeOf(source);
    source->failBelow = 1;
    const auto found = pickLine(*appearance, {{31.0, 30.0, -50.0}, {31.0, 30.0, 150.0}});
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->level, 1);
}

// A wall that moves by ten voxels a step.
double wall(const glm::dvec3& p, int step)
{
    return p.z > 10.0 * (step + 1) ? 1.0 : 0.0;
}

std::optional<double> heightSeen(VolumeAppearance& appearance, osg::FrameStamp* stamp)
{
    osg::ref_ptr<osgUtil::LineSegmentIntersector> segment =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(20, 20, -50), osg::Vec3d(20, 20, 100));
    osgUtil::IntersectionVisitor visitor(segment);
    visitor.setFrameStamp(stamp);
    appearance.accept(visitor);
    if (!segment->containsIntersections()) return {};
    return segment->getFirstIntersection().localIntersectionPoint.z();
}

TEST(PagedPick, SeesTheTimeStepThatIsShown)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, 3, wall);
    const auto appearance = volumeOf(source);
    for (const int step : {0, 2, 1}) {
        ASSERT_TRUE(appearance->setTimeStep(step).ok());
        const auto height = heightSeen(*appearance, nullptr);
        ASSERT_TRUE(height.has_value());
        EXPECT_NEAR(*height, 10.0 * (step + 1) + 0.7, 0.5);
    }
    ASSERT_TRUE(appearance->setTimeStep(0).ok());
    ASSERT_TRUE(appearance->setTimeRate(1.0).ok());
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(2.5);
    EXPECT_NEAR(*heightSeen(*appearance, stamp), 30.7, 0.5);
    // Half of the step before, and half of the next one: 0.5 where only one of them is.
    appearance->setTimeBlending(true);
    appearance->setLookupTable(makeTable({{0.4, {1, 1, 1, 0.0}}, {0.4, {1, 1, 1, 0.999}}}));
    stamp->setSimulationTime(0.5);
    EXPECT_NEAR(*heightSeen(*appearance, stamp), 10.9, 0.3);
    appearance->setLookupTable(makeTable({{0.6, {1, 1, 1, 0.0}}, {0.6, {1, 1, 1, 0.999}}}));
    EXPECT_NEAR(*heightSeen(*appearance, stamp), 20.3, 0.3);
}

} // namespace

} // namespace PagedPickTest
