// Accuracy that is asked for is kept, and not at the price of much more.

#include "Volumes.h"

#include <osgVolumizer/render/cull/FrameTimes.h>
#include <support/Choices.h>
#include <support/GLTest.h>

#include <cmath>

namespace ToleranceTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 48;

double blob(const glm::dvec3& p)
{
    const glm::dvec3 d = (p - 0.5 * (SIZE - 1)) / 16.0;
    const double s = 1.0 - glm::dot(d, d);
    return s > 0.0 ? s * s : 0.0;
}

struct Case
{
    const char* name;
    double (*field)(const glm::dvec3&);
    Points points;
};

std::vector<Case> cases()
{
    return {{"smooth", bumps, smoothPoints(0.08)},
            {"opaque", bumps, smoothPoints(0.9)},
            {"blob", blob, smoothPoints(0.3)},
            {"peak",
             bumps,
             {{0.0, {0.2, 0.4, 0.9, 0.0}},
              {0.48, {0.2, 0.4, 0.9, 0.0}},
              {0.5, {1.0, 0.8, 0.2, 0.6}},
              {0.52, {0.2, 0.4, 0.9, 0.0}},
              {1.0, {0.2, 0.4, 0.9, 0.0}}}},
            {"jumps",
             blob,
             {{0.0, {0.2, 0.4, 0.9, 0.0}},
              {0.3, {0.2, 0.4, 0.9, 0.0}},
              {0.3, {1.0, 0.6, 0.1, 0.3}},
              {1.0, {0.9, 0.2, 0.1, 0.1}}}}};
}

RenderOptions view(bool perspective)
{
    RenderOptions options =
        RenderOptions().size(72, 72).lookAt({95, -60, 70}, {23, 23, 23}, {0, 0, 1});
    return perspective ? options.perspective(36.0) : options.orthographic(36.0);
}

// A choice, like a fixed period, is one for all views.
std::vector<RenderOptions> views()
{
    std::vector<RenderOptions> all = {view(true), view(false)};
    for (const osg::Vec3d& eye :
         {osg::Vec3d(-55, 80, 75), osg::Vec3d(23.4, -90, 22.8), osg::Vec3d(60, 90, -70)})
        all.push_back(view(true).lookAt(eye, {23, 23, 23}, {0, 0, 1}));
    return all;
}

double samplesOf(VolumeAppearance& volume, const RenderOptions& options)
{
    double sum = 0.0;
    for (const auto& pixel :
         support::renderScene(&volume, support::countingSamples(options)).pixels)
        sum += pixel.r;
    return sum;
}

using Tolerance = support::GLTest;

// A view, and what there is to see.
struct Judge
{
    RenderOptions options;
    FloatImage expected;
    support::Mask covered;

    double rmse(osg::Node* scene) const
    {
        return compare(support::renderScene(scene, options), expected, covered).rmse;
    }
};

std::vector<Judge> judges(const TwinVolume& twin)
{
    std::vector<Judge> result;
    for (const RenderOptions& options : views()) {
        const FloatImage expected = oraclePicture(oracleScene(twin.oracle), options);
        result.push_back({options, expected, support::coveredPixels(expected, 1e-3f)});
    }
    return result;
}

TEST_F(Tolerance, IsKeptInEveryScene)
{
    double logarithms = 0.0;
    int count = 0;
    for (const Case& c : cases()) {
        TwinVolume twin = makeTwin(makeVoxels(glm::ivec3(SIZE), c.field), c.points);
        const std::vector<Judge> all = judges(twin);
        const auto samples = [&]() {
            double sum = 0.0;
            for (const Judge& judge : all)
                sum += samplesOf(*twin.node, judge.options);
            return sum;
        };
        const auto keeps = [&](double tolerance) {
            return std::all_of(all.begin(), all.end(), [&](const Judge& judge) {
                return judge.rmse(twin.node) <= tolerance;
            });
        };
        for (const double tolerance : {4e-3, 1e-3}) {
            twin.node->setLookup(VolumeAppearance::AUTOMATIC_LOOKUP);
            ASSERT_TRUE(twin.node->setErrorTolerance(tolerance));
            ASSERT_TRUE(support::waitForChoice(*twin.node));
            EXPECT_TRUE(keeps(tolerance)) << c.name << ", tolerance " << tolerance;
            const double chosen = samples();
#ifdef __SANITIZE_ADDRESS__
            continue; // what follows takes minutes, and is the same code with other numbers
#endif
            // The fewest samples of a fixed period that does in the same views, with either table.
            ASSERT_TRUE(twin.node->setErrorTolerance(0.0));
            double fewest = INFINITY;
            for (const auto lookup :
                 {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::PREINTEGRATED}) {
                twin.node->setLookup(lookup);
                for (double period = 8.0; period > 0.1; period *= 0.8) {
                    twin.setPeriod(period);
                    if (!keeps(tolerance)) continue;
                    fewest = std::min(fewest, samples());
                    break;
                }
            }
            EXPECT_LE(chosen, 2.0 * fewest) << c.name << ", tolerance " << tolerance;
            logarithms += std::log(chosen / fewest);
            ++count;
        }
    }
    EXPECT_LT(logarithms, count * std::log(1.4) + 1e-9);
}

} // namespace

TEST_F(Tolerance, FollowsTableAndData)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    ASSERT_TRUE(volume->setErrorTolerance(1e-3));
    volume->setLookup(VolumeAppearance::AFTER_INTERPOLATION); // so that periods tell all
    support::SceneRenderer renderer(volume, view(true));
    const auto voxelsPerSample = [&](const Points& points) {
        volume->getLookupTable()->setPoints(points, LookupTable::RANGE_FRACTION);
        EXPECT_TRUE(support::waitForChoice(*volume));
        renderer.render();
        return renderer.counters().at("osgVolumizer voxels per sample");
    };
    const double smooth = voxelsPerSample(smoothPoints(0.05));
    const double sharp = voxelsPerSample(cases()[3].points);
    EXPECT_LT(sharp, 0.5 * smooth);
    EXPECT_EQ(voxelsPerSample(smoothPoints(0.05)), smooth);
    ASSERT_TRUE(volume->setErrorTolerance(4e-3));
    const double looser = voxelsPerSample(smoothPoints(0.05));
    // Second order: four times the error is twice the period.
    EXPECT_NEAR(looser / smooth, 2.0, 0.45);
    // Constant voxels need no samples to speak of.
    auto* source = static_cast<MemoryVoxelSource*>(voxels->getSource());
    std::fill_n(static_cast<float*>(source->data()), SIZE * SIZE * SIZE, 0.5f);
    voxels->dirty();
    EXPECT_GT(voxelsPerSample(smoothPoints(0.05)), 7.0);
}

// Frames go on while a choice is made, with what keeps any tolerance, and after a change of the
// table as after one of the data.
TEST_F(Tolerance, FramesDoNotWaitForIt)
{
    TwinVolume twin = makeTwin(makeVoxels(glm::ivec3(SIZE), bumps), cases()[3].points);
    ASSERT_TRUE(twin.node->setErrorTolerance(1e-3));
    const VolumeGeometry& geometry = dynamic_cast<const VolumeGeometry&>(*twin.node->getChild(0));
    support::SceneRenderer renderer(twin.node, view(true));
    const auto settings = [&]() { return twin.node->getSettingsInForce(geometry); };
    VolumeAppearance::Settings first = settings();
    EXPECT_TRUE(first.refining);
    EXPECT_EQ(first.lookup, VolumeAppearance::CELL_BY_CELL);
    EXPECT_EQ(first.expectedError, 0.0);
    const FloatImage expected = oraclePicture(oracleScene(twin.oracle), view(true));
    const support::Mask covered = support::coveredPixels(expected, 1e-3f);
    EXPECT_LE(compare(renderer.render(), expected, covered).rmse, 1e-3);
    ASSERT_TRUE(support::waitForChoice(*twin.node));
    const VolumeAppearance::Settings last = settings();
    EXPECT_FALSE(last.refining);
    EXPECT_GT(last.expectedError, 0.0);
    EXPECT_LE(last.expectedError, 1e-3);
    EXPECT_LE(compare(renderer.render(), expected, covered).rmse, 1e-3);
    // A point that is dragged: each frame has its own table, and none of them is late.
    for (int i = 0; i < 30; ++i) {
        Points points = cases()[3].points;
        points[2].value += 1e-4 * i;
        twin.node->getLookupTable()->setPoints(points, LookupTable::RANGE_FRACTION);
        renderer.render();
    }
    ASSERT_TRUE(support::waitForChoice(*twin.node));
    // One that was forgotten half way is chosen when it comes back.
    twin.node->getLookupTable()->setPoints(cases()[3].points, LookupTable::RANGE_FRACTION);
    ASSERT_TRUE(support::waitForChoice(*twin.node));
    EXPECT_NEAR(settings().expectedError, last.expectedError, 1e-12);
}

// What cannot be kept is said: cubic interpolation has no cells to split at.
TEST_F(Tolerance, WhatCannotBeKeptIsSaid)
{
    TwinVolume twin = makeTwin(makeVoxels(glm::ivec3(SIZE), bumps), cases()[3].points);
    ASSERT_TRUE(twin.node->setErrorTolerance(1e-5));
    twin.node->setInterpolation(VolumeAppearance::CUBIC);
    ASSERT_TRUE(support::waitForChoice(*twin.node));
    const VolumeGeometry& geometry = dynamic_cast<const VolumeGeometry&>(*twin.node->getChild(0));
    const VolumeAppearance::Settings settings = twin.node->getSettingsInForce(geometry);
    EXPECT_GT(settings.expectedError, 1e-5);
    const bool said = std::any_of(settings.reasons.begin(), settings.reasons.end(),
                                  [](const std::string& reason) {
                                      return reason.find("an error of 1e-05 cannot be kept") == 0;
                                  });
    EXPECT_TRUE(said);
}

TEST_F(Tolerance, MovingViewsAreCoarserOnly)
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    volume->setLookupTable(makeTable(smoothPoints(0.1)));
    support::SceneRenderer renderer(volume, view(true));
    const FloatImage plain = renderer.render();
    ASSERT_TRUE(volume->setTargetFrameTime(1e-9)); // out of reach
    const auto voxelsPerSample = [&]() {
        renderer.render();
        return renderer.counters().at("osgVolumizer voxels per sample");
    };
    EXPECT_EQ(support::compare(renderer.render(), plain).maximum, 0.0);
    const double atRest = voxelsPerSample();
    int i = 1;
    for (const double reduction : {1.3, 8.0, 128.0}) {
        support::viewHooks(renderer.viewer()).reduction = reduction;
        renderer.options().lookAt({95, -60.0 + i++, 70}, {23, 23, 23}, {0, 0, 1});
        EXPECT_NEAR(voxelsPerSample(), atRest * render::reducedSampling(reduction).stretch,
                    0.02 * atRest * reduction);
    }
    renderer.options() = view(true);
    renderer.render();
    EXPECT_EQ(support::compare(renderer.render(), plain).maximum, 0.0);
}

} // namespace ToleranceTest
