// Voxels of several time steps: which is shown when, and what is read and uploaded for it.

#include "PagedScene.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/VoxelSeries.h>

#include <support/GLTest.h>
#include <support/Reports.h>

#include <glm/common.hpp>

#include <cmath>

namespace TimeStepsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using namespace osgVolumizer::test::paged;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 40, STEPS = 5;
const osg::Vec3d EYE(85, -55, 62);

double wavesOf(const glm::dvec3& p, int step)
{
    return 0.5 + 0.2 * std::sin(0.11 * p.x + 0.9 * step) + 0.2 * std::cos(0.07 * p.y + 0.05 * p.z);
}

// The picture of a volume in memory.
FloatImage inMemory(const FormulaSource::Function& value, A* look = nullptr)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), value);
    // Slices are sampled brick by brick.
    if (look && look->getTechnique() == A::SLICES) {
        EXPECT_TRUE(voxels->setBrickSize({PAGE + 1, PAGE + 1, PAGE + 1}));
    }
    const osg::ref_ptr<A> expected = makeVolume(voxels);
    expected->setLookupTable(look ? look->getLookupTable() : makeTable(smoothPoints(0.05)).get());
    if (look) {
        expected->setShading(look->getShading());
        expected->setGradients(look->getGradients());
        expected->setTechnique(look->getTechnique());
        expected->setExactFiltering(look->getExactFiltering());
        expected->setRayFunction(look->getRayFunction());
    }
    return support::renderScene(expected, viewOf(SIZE, EYE));
}

FormulaSource::Function atStep(int step)
{
    return [step](const glm::dvec3& p) { return wavesOf(p, step); };
}

double uploaded(support::SceneRenderer& renderer)
{
    return renderer.counters()["osgVolumizer bricks uploaded"];
}

class TimeSteps : public support::GLTest
{
protected:
    void TearDown() override { setPagingBudget(defaultPagingBudget()); }

    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, STEPS, wavesOf);
    osg::ref_ptr<A> volume = volumeOf(source);
};

} // namespace

TEST_F(TimeSteps, EachIsThePictureOfItsOwnVoxels)
{
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    for (const int step : {0, 3, 4, 1}) {
        ASSERT_TRUE(volume->setTimeStep(step));
        const FloatImage picture = settle(renderer);
        EXPECT_LT(largest(picture, inMemory(atStep(step))), 1e-4) << step;
        support::savePicture(picture, "time_step_" + std::to_string(step));
    }
    // Beyond the ends are the ends.
    volume->setTimeStep(77.0);
    EXPECT_LT(largest(settle(renderer), inMemory(atStep(STEPS - 1))), 1e-4);
    volume->setTimeStep(-3.5);
    EXPECT_LT(largest(settle(renderer), inMemory(atStep(0))), 1e-4);
}

TEST_F(TimeSteps, BetweenStepsValuesAreBlended)
{
    volume->setTimeBlending(true);
    FloatImage plain;
    for (const bool shaded : {false, true})
        for (const auto gradients : {A::ON_THE_FLY, A::PRECOMPUTED})
            for (const auto technique : {A::SLABS, A::SLICES})
                for (const bool exact : {false, true}) {
                    if (!shaded && gradients == A::PRECOMPUTED) continue;
                    // Bricks that share more for shading are cut elsewhere than pages.
                    if (shaded && technique == A::SLICES) continue;
                    volume->setShading(shaded);
                    volume->setGradients(gradients);
                    volume->setTechnique(technique);
                    volume->setExactFiltering(exact);
                    volume->setTimeStep(2.25);
                    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
                    const FloatImage picture = settle(renderer);
                    const FloatImage expected = inMemory(
                        [](const glm::dvec3& p) {
                            return glm::mix(wavesOf(p, 2), wavesOf(p, 3), 0.25);
                        },
                        volume);
                    EXPECT_LT(largest(picture, expected), 2e-4)
                        << shaded << gradients << technique << exact;
                    if (shaded) {
                        EXPECT_GT(largest(picture, plain), 0.02);
                    }
                    if (!shaded && technique == A::SLABS) plain = picture;
                }
}

TEST_F(TimeSteps, RaysThatGatherBlendToo)
{
    volume->setTimeBlending(true);
    volume->setTimeStep(0.5);
    for (const auto function : {A::MAXIMUM, A::AVERAGE, A::ISOSURFACE}) {
        volume->setRayFunction(function);
        support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
        const FloatImage expected = inMemory(
            [](const glm::dvec3& p) { return 0.5 * (wavesOf(p, 0) + wavesOf(p, 1)); }, volume);
        // The outline of a surface may be a pixel off.
        const FloatImage picture = settle(renderer);
        const auto both = support::coveredPixels(picture) & support::coveredPixels(expected);
        EXPECT_LT(support::compare(picture, expected, both).rmse, 2e-3) << function;
        EXPECT_GT(both.count(), 500u) << function;
    }
}

TEST_F(TimeSteps, TheyArePlayedBySimulationTime)
{
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    ASSERT_TRUE(volume->setTimeRate(2.0));
    const auto shownAt = [&](double time) {
        renderer.options().time = time;
        return settle(renderer);
    };
    EXPECT_LT(largest(shownAt(0.0), inMemory(atStep(0))), 1e-4);
    EXPECT_LT(largest(shownAt(0.9), inMemory(atStep(1))), 1e-4);
    EXPECT_LT(largest(shownAt(2.4), inMemory(atStep(4))), 1e-4);
    EXPECT_LT(largest(shownAt(2.6), inMemory(atStep(0))), 1e-4) << "over and over";
    volume->setTimeRate(-2.0);
    EXPECT_LT(largest(shownAt(0.1), inMemory(atStep(4))), 1e-4) << "backwards";
    EXPECT_DOUBLE_EQ(volume->getTimeStepAt(0.1), 4.8);
    EXPECT_DOUBLE_EQ(volume->getTimeStepAt(2.5), 0.0);
    volume->setTimeBlending(true);
    volume->setTimeRate(1.0);
    EXPECT_DOUBLE_EQ(volume->getTimeStepAt(4.5), 0.5) << "the last is followed by the first";
    EXPECT_EQ(volume->getTimeStepAt(1e300), volume->getTimeStepAt(1e300));
}

// Half of the volume stays as it is.
TEST_F(TimeSteps, OnlyBricksThatDifferAreUploaded)
{
    const auto half = [](const glm::dvec3& p, int step) {
        return p.z < 17.0 ? wavesOf(p, 0) : wavesOf(p, step);
    };
    volume = volumeOf(source = new FormulaSource(SIZE, STEPS, half));
    PagingBudget budget = getPagingBudget();
    budget.uploadMilliseconds = 1e6;
    setPagingBudget(budget);
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE).size(320, 320));
    const auto uploadsUntilThere = [&]() {
        double count = 0.0;
        renderUntil(renderer, [&](const FloatImage&) {
            count += uploaded(renderer);
            return renderer.counters()["osgVolumizer pages missing"] == 0.0;
        });
        return count;
    };
    uploadsUntilThere();
    volume->setTimeStep(1);
    // 3 x 3 of 3 x 3 x 3 bricks do not reach beyond; coarser ones all do.
    const double next = uploadsUntilThere();
    EXPECT_GE(next, 18.0);
    EXPECT_LE(next, 18.0 + 9.0);
    // What has been there is there.
    volume->setTimeStep(0);
    EXPECT_EQ(uploadsUntilThere(), 0.0);
}

TEST_F(TimeSteps, TheNextAreReadAhead)
{
    volume->setTimeRate(1.0);
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    settle(renderer);
    int idle = 0; // frames in a row
    renderUntil(renderer, [&](const FloatImage&) {
        idle = renderer.counters()["osgVolumizer pages waited for"] == 0.0 ? idle + 1 : 0;
        return idle > 6;
    });
    // Steps 0 to 3 have been read; the source answers no more, and time goes on.
    source->openFrom(8);
    for (const int step : {1, 2, 3}) {
        renderer.options().time = step + 0.1;
        EXPECT_LT(largest(settle(renderer), inMemory(atStep(step))), 1e-4) << step;
    }
    source->openFrom(0);
}

// No frame is torn: what is shown is all of one step, the last that was there.
TEST_F(TimeSteps, AStepIsShownOnceAllOfItIsThere)
{
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    const FloatImage first = settle(renderer);
    source->openFrom(1); // not the finest level
    volume->setTimeStep(2);
    for (int frame = 0; frame < 20; ++frame)
        EXPECT_EQ(largest(renderer.render(), first), 0.0);
    EXPECT_GT(renderer.counters()["osgVolumizer pages missing"], 0.0);
    // While they are waited for, others are asked for: those that were begun with come first.
    volume->setTimeStep(4);
    source->openFrom(0);
    bool isTorn = false;
    const FloatImage second = inMemory(atStep(2)), third = inMemory(atStep(4));
    renderUntil(renderer, [&](const FloatImage& picture) {
        isTorn = isTorn || (largest(picture, first) > 1e-4 && largest(picture, second) > 1e-4 &&
                            largest(picture, third) > 1e-4);
        return renderer.counters()["osgVolumizer pages missing"] == 0.0;
    });
    EXPECT_FALSE(isTorn);
    EXPECT_LT(largest(renderer.render(), third), 1e-4);
}

TEST_F(TimeSteps, AFireThatBeginsWithNothingIsShown)
{
    const auto fire = [](const glm::dvec3& p, int step) {
        return step == 0 ? 0.0 : wavesOf(p, step);
    };
    source = new FormulaSource(SIZE, STEPS, fire);
    volume = volumeOf(source);
    volume->setLookupTable(makeTable({{0.0, {0, 0, 0, 0}}, {1.0, {1, 1, 1, 0.1}}}));
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    EXPECT_EQ(covered(settle(renderer)), 0u);
    volume->setTimeStep(1);
    EXPECT_GT(covered(settle(renderer)), 1000u);
    volume->setTimeStep(0);
    EXPECT_EQ(covered(settle(renderer)), 0u);
}

TEST_F(TimeSteps, BudgetsHoldWhilePlaying)
{
    constexpr std::int64_t MEGABYTE = 1 << 20;
    PagingBudget budget = defaultPagingBudget();
    budget.memoryBytes = budget.textureBytes = 2 * MEGABYTE;
    budget.threads = 3;
    ASSERT_TRUE(setPagingBudget(budget));
    source = new FormulaSource(100, 30, wavesOf, VoxelType::UINT8);
    volume = volumeOf(source);
    volume->setTimeRate(10.0);
    volume->setTimeBlending(true);
    support::SceneRenderer renderer(volume, viewOf(100, {210, -130, 150}));
    settle(renderer);
    for (int frame = 0; frame < 60; ++frame) {
        renderer.options().time = 0.04 * frame;
        EXPECT_GT(covered(renderer.render()), 1000u);
        auto counters = renderer.counters();
        EXPECT_LE(counters["osgVolumizer bytes of pages"], double(budget.memoryBytes));
        EXPECT_LE(counters["osgVolumizer bytes of page textures"], double(budget.textureBytes));
    }
    volume->setTimeRate(0.0);
    settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
}

TEST_F(TimeSteps, TwoInOnePlaceAreBlendedTogether)
{
    volume->setTimeBlending(true);
    volume->setTimeStep(1.5);
    const osg::ref_ptr<A> other = volumeOf(new FormulaSource(SIZE, STEPS, wavesOf));
    other->setTimeStep(3.0);
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(volume);
    both->addChild(other);
    const osg::ref_ptr<osg::Group> expected = new osg::Group;
    for (const FormulaSource::Function& value : {FormulaSource::Function([](const glm::dvec3& p) {
                                                     return 0.5 * (wavesOf(p, 1) + wavesOf(p, 2));
                                                 }),
                                                 atStep(3)}) {
        const osg::ref_ptr<A> v = makeVolume(makeVoxels(glm::ivec3(SIZE), value));
        v->setLookupTable(makeTable(smoothPoints(0.05)));
        expected->addChild(v);
    }
    support::SceneRenderer renderer(both, viewOf(SIZE, EYE));
    const FloatImage picture = settle(renderer);
    const FloatImage there = support::renderScene(expected, viewOf(SIZE, EYE));
    // Bricks of one each are marched together, those of the other one after another.
    const auto difference = support::compare(picture, there, support::coveredPixels(there));
    EXPECT_LT(difference.rmse, 2e-3);
}

TEST_F(TimeSteps, ASeriesOfSourcesIsPlayed)
{
    std::vector<osg::ref_ptr<VoxelSource>> steps;
    for (int step = 0; step < STEPS; ++step)
        steps.push_back(makeVoxels(glm::ivec3(SIZE), atStep(step))->getSource());
    const osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    ASSERT_TRUE(series->setSteps(steps));
    volume = volumeOf(series);
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    for (const int step : {0, 4, 2}) {
        volume->setTimeStep(step);
        EXPECT_LT(largest(settle(renderer), inMemory(atStep(step))), 1e-4) << step;
    }
}

TEST_F(TimeSteps, AStepThatFailsLeavesThePictureAndOneMessage)
{
    const support::Reports reports;
    std::vector<osg::ref_ptr<VoxelSource>> steps;
    for (int step = 0; step < 3; ++step)
        steps.push_back(makeVoxels(glm::ivec3(step == 1 ? 30 : SIZE), atStep(step))->getSource());
    const osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    ASSERT_TRUE(series->setSteps(steps));
    volume = volumeOf(series);
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    const FloatImage first = settle(renderer);
    volume->setTimeStep(1);
    const FloatImage picture = renderUntil(renderer, [&](const FloatImage&) {
        return renderer.counters()["osgVolumizer pages failed"] > 0.0;
    });
    EXPECT_EQ(largest(picture, first), 0.0);
    EXPECT_EQ(reports.count("time step 1 has 30,30,30 voxels"), 1);
    volume->setTimeStep(2);
    EXPECT_LT(largest(settle(renderer), inMemory(atStep(2))), 1e-4);
}

TEST_F(TimeSteps, ThePictureBecomesFinalOnce)
{
    std::vector<std::int64_t> missing;
    setPagingCallback([&](const PagingEvent& event) {
        EXPECT_EQ(event.voxels, volume->getVoxels());
        EXPECT_NE(event.camera, nullptr);
        missing.push_back(event.missing);
    });
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    settle(renderer);
    renderer.render();
    volume->setTimeStep(3);
    settle(renderer);
    setPagingCallback({});
    ASSERT_EQ(missing.size(), 4u);
    EXPECT_GT(missing[0], 0);
    EXPECT_EQ(missing[1], 0);
    EXPECT_GT(missing[2], 0);
    EXPECT_EQ(missing[3], 0);
    volume->getVoxels()->dirty();
    settle(renderer);
    EXPECT_EQ(missing.size(), 4u);
}

// A viewer that draws on demand would stop at the coarse picture.
TEST_F(TimeSteps, ViewersOnDemandGoOnUntilThePictureIsFinal)
{
    support::SceneRenderer renderer(volume, viewOf(SIZE, EYE));
    osgViewer::Viewer& viewer = renderer.viewer();
    renderer.render();
    const auto start = std::chrono::steady_clock::now();
    // As osgViewer::ViewerBase::run() does.
    while (viewer.checkNeedToDoFrame() && secondsSince(start) < 200.0)
        renderer.render();
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    EXPECT_FALSE(viewer.checkNeedToDoFrame());
    // Time that goes on has no final picture.
    volume->setTimeRate(1.0);
    settle(renderer);
    EXPECT_TRUE(viewer.checkNeedToDoFrame());
    volume->setTimeRate(0.0);
    settle(renderer);
    EXPECT_FALSE(viewer.checkNeedToDoFrame());
}

} // namespace TimeStepsTest
