// Voxels that are read in the background, page by page, within budgets.

#include "PagedScene.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/render/textures/PageQueue.h>

#include <support/GLTest.h>
#include <support/Instrumented.h>
#include <support/Reports.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include <malloc.h>

namespace PagesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using namespace osgVolumizer::test::paged;
using A = VolumeAppearance;

namespace {

constexpr std::int64_t MEGABYTE = 1 << 20;

// A number of kilobytes that the system keeps about this process, in bytes; 0 where it does not.
std::int64_t statusBytes(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    std::string word;
    std::int64_t kilobytes = 0;
    while (status >> word)
        if (word == name + ":" && status >> kilobytes) return 1024 * kilobytes;
    return 0;
}

// On demand some tests are as large as what they are about.
bool isLarge()
{
    return std::getenv("OSGVOLUMIZER_TEST_LARGE") != nullptr;
}

std::int64_t residentBytes()
{
    return statusBytes("VmRSS");
}

std::int64_t peakBytes()
{
    return statusBytes("VmHWM");
}

void forgetPeak()
{
    std::ofstream("/proc/self/clear_refs") << "5";
}

// By malloc(); 0 under a sanitizer, which has its own.
std::int64_t allocatedBytes()
{
    const struct mallinfo2 info = mallinfo2();
    return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
}

class Pages : public support::GLTest
{
protected:
    void TearDown() override { setPagingBudget(defaultPagingBudget()); }
    static void setBudget(std::int64_t memoryBytes, std::int64_t textureBytes)
    {
        PagingBudget budget = defaultPagingBudget();
        budget.memoryBytes = memoryBytes;
        budget.textureBytes = textureBytes;
        budget.threads = 3;
        ASSERT_TRUE(setPagingBudget(budget));
    }
};

} // namespace

TEST_F(Pages, AtRestThePictureIsThatOfAVolumeInMemory)
{
    constexpr int size = 70;
    const osg::ref_ptr<Voxels> inMemory = makeVoxels(glm::ivec3(size), waves);
    const osg::ref_ptr<A> expected = makeVolume(inMemory);
    expected->setLookupTable(makeTable(smoothPoints(0.05)));
    for (const osg::Vec3d& eye : {osg::Vec3d(150, -90, 110), {-60, 20, 45}, {35, 30, 38}}) {
        const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
        support::SceneRenderer renderer(volumeOf(source), viewOf(size, eye));
        const FloatImage picture = settle(renderer);
        EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
        EXPECT_EQ(renderer.counters()["osgVolumizer pages waited for"], 0.0);
        EXPECT_GT(source->reads[0], 0);
        const FloatImage there = support::renderScene(expected, viewOf(size, eye));
        EXPECT_LT(largest(picture, there), 1e-4);
        support::savePicture(picture, "pages_at_rest");
        // And stays as it is.
        const int before = source->reads[0];
        EXPECT_EQ(largest(renderer.render(), picture), 0.0);
        EXPECT_EQ(source->reads[0], before);
    }
}

TEST_F(Pages, SlicesShowTheSame)
{
    constexpr int size = 50;
    const RenderOptions view = viewOf(size, {90, -60, 70});
    const osg::ref_ptr<Voxels> bricked = makeVoxels(glm::ivec3(size), waves);
    ASSERT_TRUE(bricked->setBrickSize({PAGE + 1, PAGE + 1, PAGE + 1}));
    const osg::ref_ptr<A> expected = makeVolume(bricked);
    const osg::ref_ptr<A> paged = volumeOf(new FormulaSource(size, waves));
    for (const osg::ref_ptr<A>& volume : {expected, paged}) {
        volume->setLookupTable(makeTable(smoothPoints(0.05)));
        volume->setTechnique(A::SLICES);
    }
    support::SceneRenderer renderer(paged, view);
    const FloatImage picture = settle(renderer), there = support::renderScene(expected, view);
    EXPECT_LT(largest(picture, there), 1e-5);
}

TEST_F(Pages, NoFrameWaitsForARead)
{
    constexpr int size = 70;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    source->openFrom(8); // nothing
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {150, -90, 110}));
    for (int frame = 0; frame < 20; ++frame)
        EXPECT_EQ(covered(renderer.render()), 0u);
    source->waitForReader();
    EXPECT_GT(renderer.counters()["osgVolumizer pages missing"], 0.0);
    // The coarse levels come, the finest does not.
    source->openFrom(1);
    constexpr double pages = 27.0; // of the level above the finest
    int quiet = 0; // frames in which nothing came: parts of coarser pages count, too
    const auto isShown = [&](const FloatImage& picture) {
        quiet = renderer.counters()["osgVolumizer bricks uploaded"] > 0.0 ? 0 : quiet + 1;
        return covered(picture) > 1000 && quiet > 20 &&
               renderer.counters()["osgVolumizer bricks drawn"] >= pages;
    };
    const FloatImage coarse = renderUntil(renderer, isShown);
    EXPECT_GE(source->reads[1], int(pages));
    EXPECT_GT(quiet, 20);
    source->openFrom(0);
    const FloatImage fine = settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    // What was shown meanwhile was nearly that: there is no hole in it.
    const auto difference = support::compare(coarse, fine, support::coveredPixels(fine));
    EXPECT_LT(difference.rmse, 0.03);
    EXPECT_LT(difference.maximum, 0.15);
}

// 134 MB under budgets of 4 MB each; with OSGVOLUMIZER_TEST_LARGE 4 GB under 256 and 128.
TEST_F(Pages, BudgetsHoldInEveryFrameOfAFlight)
{
    const bool large = isLarge();
    const int size = large ? 1626 : 512;
    const std::int64_t memory = (large ? 256 : 4) * MEGABYTE;
    const std::int64_t textures = (large ? 128 : 4) * MEGABYTE;
    setBudget(memory, textures);
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    // Rows of 64 bytes, and 32: Mesa's software rasteriser pads those of 65 to 128.
    source->page = large ? 63 : 31;
    const double scale = size / 500.0;
    support::SceneRenderer renderer(
        volumeOf(source), viewOf(size, osg::Vec3d(700, -400, 600) * scale).size(256, 192));
    // Textures of a software rasteriser are pieces of the heap, between which holes are left: not
    // so where each is the system's own. And what a driver takes to start is not counted.
    mallopt(M_MMAP_THRESHOLD, 64 << 10);
    support::renderScene(volumeOf(new FormulaSource(40, waves, VoxelType::UINT8)),
                         viewOf(40, {80, -60, 70}).size(256, 192));
    const std::int64_t before = residentBytes();
    forgetPeak();
    settle(renderer);
    for (int frame = 0; frame < 60; ++frame) {
        const double a = 0.1 * frame, r = 600.0 - 8.0 * frame;
        renderer.options().lookAt(osg::Vec3d(250 + r * std::cos(a), 250 + r * std::sin(a), 300.0) *
                                      scale,
                                  osg::Vec3d(250, 250, 250) * scale, {0, 0, 1});
        EXPECT_GT(covered(renderer.render()), 1000u);
        auto counters = renderer.counters();
        EXPECT_LE(counters["osgVolumizer bytes of pages"], double(memory));
        EXPECT_LE(counters["osgVolumizer bytes of page textures"], double(textures));
        EXPECT_EQ(counters["osgVolumizer pages failed"], 0.0);
    }
    const FloatImage picture = settle(renderer);
    auto counters = renderer.counters();
    EXPECT_EQ(counters["osgVolumizer pages missing"], 0.0);
    // So much could not be held.
    const std::int64_t pageBytes = std::int64_t(source->page) * source->page * source->page;
    std::int64_t reads = 0;
    for (const auto& level : source->reads)
        reads += level;
    EXPECT_GT(reads * pageBytes, memory);
    EXPECT_GT(counters["osgVolumizer bytes of page textures"], 0.0);
    // Besides pages and textures: framebuffers, shaders, objects of the driver, which cells of
    // pages show something (a 20th of their bytes), and what the source needs to make its samples.
    const std::int64_t peak = peakBytes() - before, slack = (large ? 160 : 64) * MEGABYTE;
    if (peak > 0 && !support::INSTRUMENTED) {
        EXPECT_LT(peak, memory + textures + slack);
    }
    RecordProperty("peakMegabytes", static_cast<int>(peak / MEGABYTE));
    support::savePicture(picture, "pages_flight");
}

// With OSGVOLUMIZER_TEST_LARGE a thousand. Memory that is in use once the same picture is final
// does not depend on how long was flown.
TEST_F(Pages, RandomFlightLeavesNothing)
{
    constexpr int size = 200;
    setBudget(4 * MEGABYTE, 3 * MEGABYTE);
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {300, -160, 240}).size(48, 40));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-100.0, 300.0);
    const auto fly = [&](int frames) {
        for (int frame = 0; frame < frames; ++frame) {
            renderer.options().lookAt({place(random), place(random), place(random)},
                                      {100, 100, 100}, {0, 0, 1});
            renderer.render();
        }
        renderer.options().lookAt({300, -160, 240}, {100, 100, 100}, {0, 0, 1});
        settle(renderer);
        return allocatedBytes();
    };
    const int few = isLarge() ? 1 : 10;
    const std::int64_t before = fly(300 / few), after = fly(700 / few);
    EXPECT_LT(after - before, 2 * MEGABYTE);
    RecordProperty("growthKilobytes", static_cast<int>((after - before) / 1024));
}

// The guide's volume of interest: a box that moves through a volume, with a budget of its own.
TEST_F(Pages, ARegionOfInterestRoams)
{
    constexpr int size = 160, edge = 50;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
    const osg::ref_ptr<A> volume = volumeOf(source);
    auto* region = dynamic_cast<VolumeGeometry*>(volume->getChild(0));
    ASSERT_NE(region, nullptr);
    ASSERT_TRUE(volume->getVoxels()->setTextureBudget(8 * MEGABYTE));
    const osg::ref_ptr<A> expected = makeVolume(makeVoxels(glm::ivec3(size), waves));
    expected->setLookupTable(volume->getLookupTable());
    auto* sameRegion = dynamic_cast<VolumeGeometry*>(expected->getChild(0));
    const auto moveTo = [&](int x) {
        const osg::BoundingBoxd box(x, 40, 40, x + edge, 40 + edge, 40 + edge);
        EXPECT_TRUE(region->setBox(box));
        EXPECT_TRUE(sameRegion->setBox(box));
    };
    const auto view = [&](int x) {
        return RenderOptions().size(160, 120).perspective(40.0).lookAt(
            osg::Vec3d(x + 60, -40, 120), osg::Vec3d(x + 25, 65, 65), {0, 0, 1});
    };
    moveTo(0);
    support::SceneRenderer renderer(volume, view(0));
    settle(renderer);
    for (const int x : {16, 32, 48, 100}) {
        moveTo(x);
        renderer.options().lookAt(osg::Vec3d(x + 60, -40, 120), osg::Vec3d(x + 25, 65, 65),
                                  {0, 0, 1});
        const int before = source->reads[0];
        const FloatImage picture = settle(renderer);
        EXPECT_LT(largest(picture, support::renderScene(expected, view(x))), 1e-4) << x;
        EXPECT_LE(renderer.counters()["osgVolumizer bytes of page textures"], 8.0 * MEGABYTE);
        // A layer of 4 x 4 pages has come into the box; or, further on, five of them.
        EXPECT_LE(source->reads[0] - before, x < 100 ? 25 : 125) << x;
        EXPECT_GT(source->reads[0], before);
    }
}

TEST_F(Pages, ABudgetOfTheirOwnMakesVoxelsCoarser)
{
    constexpr int size = 160;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
    const osg::ref_ptr<A> volume = volumeOf(source);
    const support::Reports reports;
    EXPECT_EQ(Status(volume->getVoxels()->setTextureBudget(1000)).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(volume->getVoxels()->getTextureBudget(), 0);
    ASSERT_TRUE(volume->getVoxels()->setTextureBudget(2 * MEGABYTE));
    support::SceneRenderer renderer(volume, viewOf(size, {300, -160, 240}).size(256, 200));
    for (const double turn : {0.0, 1.0, 2.0}) {
        renderer.options().lookAt(
            osg::Vec3d(80 + 200 * std::cos(turn), 80 + 200 * std::sin(turn), 200), {80, 80, 80},
            {0, 0, 1});
        settle(renderer);
        EXPECT_LE(renderer.counters()["osgVolumizer bytes of page textures"], 2.0 * MEGABYTE);
        EXPECT_EQ(renderer.counters()["osgVolumizer pages limited by the budget"], 1.0);
    }
}

TEST_F(Pages, FromAfarNothingFinerThanPixelsIsRead)
{
    constexpr int size = 500;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {2500, -1500, 1800}));
    settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    EXPECT_EQ(source->reads[0], 0);
    EXPECT_EQ(source->reads[1], 0);
    EXPECT_GT(source->reads[3] + source->reads[4], 0);
}

// A source that knows its ranges: what shows nothing is not read, nor is what has one value.
TEST_F(Pages, EmptyAndUniformPagesAreNotRead)
{
    constexpr int size = 128;
    // Nothing outside a ball, one value inside of it, and a rim.
    const auto ball = [](const glm::dvec3& p) {
        const double r = glm::length(p - 63.5);
        return r > 40.0 ? 0.0 : r < 30.0 ? 1.0 : 0.1 * (40.0 - r);
    };
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, ball, VoxelType::UINT8);
    source->range = [](int level, const core::Box3i& region) {
        const double spacing = 1 << level;
        const glm::dvec3 low = spacing * glm::dvec3(region.min);
        const glm::dvec3 high = spacing * glm::dvec3(region.max);
        const glm::dvec3 nearest = glm::clamp(glm::dvec3(63.5), low, high);
        const glm::dvec3 farthest = glm::max(glm::abs(low - 63.5), glm::abs(high - 63.5));
        const double a = glm::length(nearest - 63.5), b = glm::length(farthest);
        return std::optional<std::pair<double, double>>(std::in_place,
                                                        b < 30.0   ? 255.0
                                                        : b > 40.0 ? 0.0
                                                                   : 25.5 * (40.0 - b),
                                                        a > 40.0   ? 0.0
                                                        : a < 30.0 ? 255.0
                                                                   : 25.5 * (40.0 - a));
    };
    const RenderOptions view = viewOf(size, {220, -120, 160}).size(320, 260);
    support::SceneRenderer renderer(volumeOf(source), view);
    const FloatImage picture = settle(renderer);
    auto counters = renderer.counters();
    EXPECT_EQ(counters["osgVolumizer pages missing"], 0.0);
    EXPECT_GT(counters["osgVolumizer bricks empty"], 50.0);
    EXPECT_GT(counters["osgVolumizer bricks homogeneous"], 0.0);
    EXPECT_LT(source->reads[0], 450); // of 512
    const osg::ref_ptr<FormulaSource> all = new FormulaSource(size, ball, VoxelType::UINT8);
    support::SceneRenderer other(volumeOf(all), view);
    EXPECT_LT(largest(picture, settle(other)), 2e-4);
    EXPECT_EQ(all->reads[0], 512);
}

TEST_F(Pages, ADiskThatFailsNowAndThenIsAskedAgain)
{
    constexpr int size = 70;
    const support::Reports reports;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
    source->failEvery = 5;
    const RenderOptions view = viewOf(size, {150, -90, 110});
    support::SceneRenderer renderer(volumeOf(source), view);
    const FloatImage picture = settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    const osg::ref_ptr<A> expected = makeVolume(makeVoxels(glm::ivec3(size), waves));
    expected->setLookupTable(makeTable(smoothPoints(0.05)));
    EXPECT_LT(largest(picture, support::renderScene(expected, view)), 1e-4);
    EXPECT_EQ(reports.count("the disk is dead"), 1);
}

// From afar, samples of a coarser level are several voxels apart, however they are interpolated.
TEST_F(Pages, CoarseOnesLieWhereTheyAreWhateverTheInterpolation)
{
    constexpr int LARGE = 120;
    const auto picture = [&](const std::function<void(A&)>& change) {
        const osg::ref_ptr<FormulaSource> source = new FormulaSource(LARGE, waves);
        const osg::ref_ptr<A> volume = volumeOf(source);
        change(*volume);
        support::SceneRenderer renderer(volume, viewOf(LARGE, {700, -500, 500}));
        const FloatImage settled = settle(renderer);
        EXPECT_EQ(source->reads[0], 0); // the volume itself is not read
        return settled;
    };
    const FloatImage linear = picture([](A&) {});
    EXPECT_GT(covered(linear), 100u);
    EXPECT_LT(largest(picture([](A& a) { a.setExactFiltering(true); }), linear), 1e-3);
    EXPECT_LT(largest(picture([](A& a) { a.setInterpolation(A::NEAREST); }), linear), 0.1);
    EXPECT_LT(largest(picture([](A& a) { a.setLookup(A::BEFORE_INTERPOLATION); }), linear), 0.02);
}

TEST_F(Pages, ADeadDiskLeavesACoarsePictureAndOneMessage)
{
    constexpr int size = 70;
    const support::Reports reports;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    source->failBelow = 1;
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {150, -90, 110}));
    const auto start = std::chrono::steady_clock::now();
    renderUntil(renderer, [&](const FloatImage& picture) {
        return covered(picture) > 1000 && source->reads[0] > 200;
    });
    const double pages = renderer.counters()["osgVolumizer pages wanted"];
    EXPECT_GT(renderer.counters()["osgVolumizer pages failed"], 0.0);
    EXPECT_EQ(reports.count("the disk is dead"), 1);
    // It is asked again after a while, each time twice as long, not in every frame.
    EXPECT_LT(source->reads[0], pages * (2.0 + std::log2(1.0 + secondsSince(start) / 0.25)));
    source->failBelow = 0;
    settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
}

TEST_F(Pages, ChangedDataAreReadAgain)
{
    constexpr int size = 40;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
    const osg::ref_ptr<A> volume = volumeOf(source);
    support::SceneRenderer renderer(volume, viewOf(size, {80, -60, 70}));
    settle(renderer);
    const int before = source->reads[0];
    volume->getVoxels()->dirty();
    renderer.render();
    settle(renderer);
    EXPECT_EQ(source->reads[0], 2 * before);
}

TEST_F(Pages, RefusedBudgetsChangeNothing)
{
    const support::Reports reports;
    const PagingBudget before = getPagingBudget();
    for (int i = 0; i < 5; ++i) {
        PagingBudget bad = before;
        if (i == 0) bad.memoryBytes = 1000;
        if (i == 1) bad.textureBytes = -1;
        if (i == 2) bad.uploadMilliseconds = 0.0;
        if (i == 3) bad.threads = 0;
        if (i == 4) bad.threads = 65;
        EXPECT_EQ(Status(setPagingBudget(bad)).code, ErrorCode::VALUE_INVALID);
    }
    EXPECT_EQ(getPagingBudget().threads, before.threads);
    EXPECT_EQ(getPagingBudget().memoryBytes, before.memoryBytes);
}

} // namespace PagesTest
