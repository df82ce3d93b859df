// Rays split at faces of cells and corners of the table: how fast the error falls, and that all
// else that a volume can be goes with it.

#include "MixedScene.h"

#include <osgVolumizer/VolumeCut.h>

#include <support/GLTest.h>

#include <osg/Fog>

#include <algorithm>
#include <cmath>
#include <random>

namespace CellByCellTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using A = VolumeAppearance;

constexpr int SIZE = 16;

// A smooth table that bends enough for errors to show.
const Points BENT{{0.0, {0.9, 0.2, 0.1, 0.02}}, {1.0, {0.1, 0.7, 0.9, 0.35}}};
const Points SHARP{{0.0, {0.9, 0.2, 0.1, 0.0}},  {0.4, {0.9, 0.2, 0.1, 0.0}},
                   {0.4, {0.2, 0.8, 0.3, 0.25}}, {0.52, {0.2, 0.8, 0.3, 0.1}},
                   {0.52, {0.9, 0.9, 0.2, 0.0}}, {0.6, {0.9, 0.9, 0.2, 0.8}},
                   {0.68, {0.9, 0.9, 0.2, 0.0}}, {1.0, {0.1, 0.7, 0.9, 0.05}}};

osg::ref_ptr<Voxels> noise(unsigned seed)
{
    std::mt19937 random(seed);
    return makeVoxels(glm::ivec3(SIZE), [&random](const glm::dvec3&) {
        return 0.1 + 0.8 * double(random()) / 4294967296.0;
    });
}

RenderOptions view(bool perspective = true)
{
    RenderOptions options =
        RenderOptions().size(64, 64).lookAt({33, -21, 26}, {7, 8, 7}, {0, 0, 1});
    return perspective ? options.perspective(32.0) : options.orthographic(20.0);
}

osg::Matrixd turned()
{
    return osg::Matrixd::rotate(0.4, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(5.5, 3.25, -2);
}

void setCells(const MixedScene& scene)
{
    for (const auto& volume : scene.volumes())
        volume->setLookup(A::CELL_BY_CELL);
}

// Of the period, from errors at 0.8, 0.4 and 0.2 voxels; the last of them.
struct Fall
{
    double order, last;
};

Fall fall(MixedScene& scene, const RenderOptions& options)
{
    scene.truth().tolerance = 1e-9;
    const oracle::Camera camera = cameraOf(options);
    const FloatImage expected = oracle::render(scene.truth(), camera);
    const support::Mask away =
        support::coveredPixels(oracle::awayFromSilhouettes(scene.truth(), camera, 1.0 / 64.0));
    const auto errorAt = [&](double period) {
        scene.setPeriod(period);
        return judge(scene, options, expected, away).away.rmse;
    };
    const double first = errorAt(0.8), middle = errorAt(0.4), last = errorAt(0.2);
    EXPECT_LT(middle, first);
    return {0.5 * std::log2(first / last), last};
}

using CellByCell = support::GLTest;

} // namespace

TEST_F(CellByCell, IsOfThirdOrderAndMore)
{
    for (const bool perspective : {true, false}) {
        MixedScene scene;
        scene.addVolume(noise(1), BENT);
        setCells(scene);
        const Fall f = fall(scene, view(perspective));
        EXPECT_GT(f.order, 2.8) << perspective;
        EXPECT_LT(f.last, 5e-6) << perspective;
    }
}

TEST_F(CellByCell, OpaqueCutsTakeNothingFromThat)
{
    MixedScene scene;
    scene.addVolume(noise(2), BENT, turned());
    scene.addQuad({glm::vec3(2, 30, -20), glm::vec3(28, -14, -20), glm::vec3(34, -10, 30),
                   glm::vec3(8, 34, 30)},
                  {0.3, 0.5, 0.2, 1.0}, true);
    setCells(scene);
    const Fall f = fall(scene, view());
    EXPECT_GT(f.order, 2.8);
    EXPECT_LT(f.last, 5e-6);
}

TEST_F(CellByCell, OverlappingVolumesTakeNothingFromThat)
{
    MixedScene scene;
    scene.addVolume(noise(3), BENT);
    scene.addVolume(noise(4), BENT, turned());
    setCells(scene);
    const Fall f = fall(scene, view());
    EXPECT_GT(f.order, 2.8);
    EXPECT_LT(f.last, 5e-6);
}

// The sharpest tables over white noise, alone and together with others.
TEST_F(CellByCell, JumpsAndPeaks)
{
    MixedScene alone, together;
    alone.addVolume(noise(5), SHARP);
    together.addVolume(noise(5), SHARP);
    together.addVolume(noise(6), SHARP, turned());
    for (MixedScene* scene : {&alone, &together}) {
        setCells(*scene);
        scene->truth().tolerance = 1e-8;
        for (const double period : {1.0, 0.25}) {
            scene->setPeriod(period);
            const Judged j = judge(*scene, view());
            EXPECT_LT(j.away.rmse, period < 1.0 ? 3e-5 : 2e-4) << scene->volumes().size();
        }
    }
}

// One of several that are marched together need not be split.
TEST_F(CellByCell, WithVolumesThatAreMarchedInSteps)
{
    MixedScene scene;
    scene.addVolume(noise(7), SHARP).setLookup(A::CELL_BY_CELL);
    scene.addVolume(noise(8), BENT, turned());
    scene.setPeriod(0.125);
    EXPECT_LT(judge(scene, view()).away.rmse, 1e-4);
}

// Everything that the shader may have to do besides, against steps of a 32nd of a voxel.
TEST_F(CellByCell, AllElseGoesWithIt)
{
    struct Kind
    {
        const char* name;
        std::function<void(A&)> set;
        double error;
    };
    const std::vector<Kind> kinds = {
        {"plain", [](A&) {}, 1e-4},
        {"lit", [](A& a) { a.setShading(true); }, 2e-3},
        {"exact filtering", [](A& a) { a.setExactFiltering(true); }, 1e-4},
        {"nearest", [](A& a) { a.setInterpolation(A::NEAREST); }, 3e-3},
        {"bricks",
         [](A& a) {
             a.getVoxels()->setBrickSize({7, 6, 9});
         },
         1e-4},
        {"fog",
         [](A& a) {
             auto* fog = new osg::Fog;
             fog->setMode(osg::Fog::LINEAR);
             fog->setStart(20.0f);
             fog->setEnd(60.0f);
             fog->setColor({0.5f, 0.6f, 0.7f, 1.0f});
             a.getOrCreateStateSet()->setAttributeAndModes(fog);
         },
         1e-4},
        {"cut",
         [](A& a) {
             osg::ref_ptr<VolumeCut> cut = new VolumeCut;
             cut->addRegion(CutRegion::sphere({8, 7, 8}, 6.0).complement());
             a.setCut(cut);
         },
         3e-4}};
    for (const Kind& kind : kinds) {
        SCOPED_TRACE(kind.name);
        osg::ref_ptr<A> volume = makeVolume(noise(9));
        volume->setLookupTable(makeTable(BENT));
        kind.set(*volume);
        RenderOptions options = view();
        options.light = true;
        volume->setLookup(A::CELL_BY_CELL);
        volume->setSamplingPeriod(osg::Vec3d(0.25, 0.25, 0.25));
        const FloatImage cells = support::renderScene(volume, options);
        volume->setLookup(A::AFTER_INTERPOLATION);
        volume->setSamplingPeriod(osg::Vec3d(1.0 / 32, 1.0 / 32, 1.0 / 32));
        const FloatImage steps = support::renderScene(volume, options);
        EXPECT_LT(support::compare(cells, steps, support::coveredPixels(steps)).rmse, kind.error);
        EXPECT_GT(support::coveredPixels(cells).count(), 400u);
    }
}

// A table that begins to show something at its first value: what has that value shows nothing.
TEST_F(CellByCell, LeapsOverTheFirstValueOfARamp)
{
    const glm::dvec3 middle(8.0);
    osg::ref_ptr<A> volume = makeVolume(makeVoxels(glm::ivec3(64), [&](const glm::dvec3& p) {
        return std::max(0.0, 1.0 - glm::length(p - middle) / 6.0);
    }));
    volume->setLookupTable(makeTable({{0.0, {1, 1, 1, 0.0}}, {1.0, {1, 1, 1, 0.5}}}));
    volume->setLookup(A::CELL_BY_CELL);
    support::SceneRenderer renderer(volume, view());
    renderer.render();
    const auto counters = renderer.counters();
    EXPECT_GT(counters.at("osgVolumizer cells occupied"), 0.0);
    EXPECT_LT(counters.at("osgVolumizer cells occupied"), 30.0); // of 512
}

// What has no cells that rays could be split at is looked up after interpolation, and that is said.
TEST_F(CellByCell, WhereItCannotBe)
{
    osg::ref_ptr<A> volume = makeVolume(noise(10));
    volume->setLookup(A::CELL_BY_CELL);
    const auto& geometry = dynamic_cast<const VolumeGeometry&>(*volume->getChild(0));
    EXPECT_EQ(volume->getSettingsInForce(geometry).lookup, A::CELL_BY_CELL);
    const auto saysLookup = [&]() {
        const auto reasons = volume->getSettingsInForce(geometry).reasons;
        return std::any_of(reasons.begin(), reasons.end(), [](const std::string& reason) {
            return reason.find("lookup") != std::string::npos;
        });
    };
    EXPECT_FALSE(saysLookup());
    volume->setInterpolation(A::CUBIC);
    EXPECT_EQ(volume->getSettingsInForce(geometry).lookup, A::AFTER_INTERPOLATION);
    EXPECT_TRUE(saysLookup());
    volume->setInterpolation(A::LINEAR);
    volume->setTechnique(A::SLICES);
    EXPECT_EQ(volume->getSettingsInForce(geometry).lookup, A::AFTER_INTERPOLATION);
}

// Extinction from 1e-9 to 1e9 an opacity unit, and data of any size.
TEST_F(CellByCell, AnyExtinctionAndAnyData)
{
    for (const double unit : {1e-9, 1.0, 1e9})
        for (const double scale : {1e-30, 1.0, 1e30}) {
            osg::ref_ptr<Voxels> voxels = makeVoxels(
                glm::ivec3(8), [scale](const glm::dvec3& p) { return scale * p.x / 7.0; });
            ASSERT_TRUE(voxels->setRange(osg::Vec2d(0.0, scale)));
            osg::ref_ptr<A> volume = makeVolume(voxels);
            volume->setLookupTable(makeTable({{0.0, {1, 1, 1, 0.3}}, {1.0, {1, 1, 1, 0.3}}}));
            volume->setLookup(A::CELL_BY_CELL);
            ASSERT_TRUE(volume->setOpacityUnit(unit));
            const FloatImage image =
                support::renderScene(volume, RenderOptions().size(8, 8).orthographic(4.0).lookAt(
                                                 {20, 3.5, 3.5}, {3.5, 3.5, 3.5}, {0, 0, 1}));
            const double opacity = -std::expm1(std::log(0.7) * 7.0 / unit);
            EXPECT_NEAR(image.at(4, 4).a, opacity, 1e-5 * opacity) << unit << " " << scale;
        }
}

} // namespace CellByCellTest
