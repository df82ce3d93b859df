// Steps that are as long as the light that they give allows, with everything else that a shader may
// have to do: against equal steps of a 32nd of a voxel.

#include "DeformedLattice.h"
#include "MixedScene.h"
#include "Volumes.h"

#include <osgVolumizer/CutRegion.h>
#include <osgVolumizer/VolumeCut.h>
#include <support/Choices.h>
#include <support/GLTest.h>
#include <support/Instrumented.h>

#include <osg/Fog>

#include <algorithm>
#include <functional>

namespace AdaptiveStepsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 24;
constexpr double TOLERANCE = 1e-3;

// Thin, and nearly opaque beyond.
const Points TABLE{{0.0, {0.9, 0.3, 0.2, 0.0}},   {0.2, {0.9, 0.3, 0.2, 0.0}},
                   {0.25, {0.9, 0.5, 0.2, 0.02}}, {0.6, {0.8, 0.5, 0.6, 0.03}},
                   {0.7, {0.2, 0.8, 0.5, 0.7}},   {1.0, {0.3, 0.1, 0.9, 0.8}}};

RenderOptions view()
{
    RenderOptions options =
        RenderOptions().size(64, 64).lookAt({55, -32, 40}, {12, 11, 12}, {0, 0, 1});
    options.perspective(30.0).light = true;
    return options;
}

osg::ref_ptr<A> makeBumps()
{
    osg::ref_ptr<A> volume = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    volume->setLookupTable(makeTable(TABLE));
    return volume;
}

bool adapts(const A& volume)
{
    const auto& geometry = dynamic_cast<const VolumeGeometry&>(*volume.getChild(0));
    const std::vector<std::string> reasons = volume.getSettingsInForce(geometry).reasons;
    return std::any_of(reasons.begin(), reasons.end(), [](const std::string& reason) {
        return reason.find("as long as the light") != std::string::npos;
    });
}

// Both with a tolerance by steps that adapt, and by equal ones.
void setAdaptive(A& volume, double tolerance)
{
    volume.setLookup(A::PREINTEGRATED);
    ASSERT_TRUE(volume.setErrorTolerance(tolerance));
    ASSERT_TRUE(support::waitForChoice(volume));
    ASSERT_TRUE(adapts(volume));
}

void setFine(A& volume)
{
    volume.setErrorTolerance(0.0);
    volume.setLookup(A::AFTER_INTERPOLATION);
    volume.setSamplingPeriod(osg::Vec3d(1.0 / 32, 1.0 / 32, 1.0 / 32));
}

using AdaptiveSteps = support::GLTest;

struct Kind
{
    const char* name;
    std::function<void(A&)> set;
    bool joins = true;       ///< bricks into one texture
    bool everywhere = false; ///< else left out where the same code is slow
};

const std::vector<Kind> KINDS = {
    {"plain", [](A&) {}},
    {"lit", [](A& a) { a.setShading(true); }, true, true},
    {"lit, gradients in a texture",
     [](A& a) {
         a.setShading(true);
         a.setGradients(A::PRECOMPUTED);
     }},
    {"exact filtering", [](A& a) { a.setExactFiltering(true); }},
    {"lit, exact filtering of gradients",
     [](A& a) {
         a.setShading(true);
         a.setGradients(A::PRECOMPUTED);
         a.setExactFiltering(true);
     }},
    {"bricks",
     [](A& a) {
         a.getVoxels()->setBrickSize({9, 11, 8});
     }},
    {"bricks apart",
     [](A& a) {
         a.getVoxels()->setBrickSize({9, 11, 8});
     },
     false},
    {"deformed", [](A& a) { a.setChild(0, deformedLattice(SIZE, 1e-6)); }, true, true},
    {"fog",
     [](A& a) {
         auto* fog = new osg::Fog;
         fog->setMode(osg::Fog::LINEAR);
         fog->setStart(30.0f);
         fog->setEnd(100.0f);
         fog->setColor({0.5f, 0.6f, 0.7f, 1.0f});
         a.getOrCreateStateSet()->setAttributeAndModes(fog);
     }},
    {"cut", [](A& a) {
         osg::ref_ptr<VolumeCut> cut = new VolumeCut;
         cut->addRegion(CutRegion::sphere({12, 10, 12}, 9.0).complement());
         a.setCut(cut);
     }}};

TEST_F(AdaptiveSteps, AllElseGoesWithThem)
{
    for (const Kind& kind : KINDS) {
        if (support::INSTRUMENTED && !kind.everywhere) continue;
        SCOPED_TRACE(kind.name);
        osg::ref_ptr<A> volume = makeBumps();
        kind.set(*volume);
        const RenderOptions options = support::joining(view(), kind.joins);
        setAdaptive(*volume, TOLERANCE);
        const FloatImage adaptive = support::renderScene(volume, options);
        setFine(*volume);
        const FloatImage fine = support::renderScene(volume, options);
        const support::Mask covered = support::coveredPixels(fine, 1e-3f);
        EXPECT_LT(support::compare(adaptive, fine, covered).rmse, TOLERANCE);
        EXPECT_GT(covered.count(), 400u);
    }
}

osg::Matrixd turned()
{
    return osg::Matrixd::rotate(0.4, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(8.5, 5.25, -3);
}

// Volumes that are marched together share their steps, whatever each of them asks for.
TEST_F(AdaptiveSteps, VolumesThatOverlapAdaptTogether)
{
    const Points thin{{0.0, {0.2, 0.4, 0.9, 0.0}}, {1.0, {0.9, 0.4, 0.2, 0.1}}};
    for (const bool both : {true, false})
        for (const A::Lookup other : {A::PREINTEGRATED, A::AFTER_INTERPOLATION, A::CELL_BY_CELL}) {
            if (both && other != A::PREINTEGRATED) continue;
            SCOPED_TRACE("lookup of the other one: " + std::to_string(other));
            MixedScene scene;
            setAdaptive(scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), TABLE), TOLERANCE);
            A& second =
                scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), both ? TABLE : thin, turned());
            if (both) {
                setAdaptive(second, TOLERANCE);
            } else {
                second.setLookup(other);
                second.setSamplingPeriod(osg::Vec3d(0.25, 0.25, 0.25));
            }
            EXPECT_LT(judge(scene, view()).away.rmse, TOLERANCE);
        }
}

// They are of second order: a quarter of the error takes about twice the samples.
TEST_F(AdaptiveSteps, AreAsManyAsTheErrorAsks)
{
    osg::ref_ptr<A> volume = makeBumps();
    const auto samples = [&]() {
        double sum = 0.0;
        for (const auto& pixel :
             support::renderScene(volume, support::countingSamples(view())).pixels)
            sum += pixel.r;
        return sum;
    };
    setAdaptive(*volume, 4e-3);
    const double coarse = samples();
    setAdaptive(*volume, 2.5e-4);
    const double fine = samples();
    EXPECT_GT(fine, 2.5 * coarse);
    EXPECT_LT(fine, 6.0 * coarse);
    const FloatImage picture = support::renderScene(volume, view());
    // Equal ones with the same table that are as good are more.
    setFine(*volume);
    const FloatImage truth = support::renderScene(volume, view());
    const support::Mask covered = support::coveredPixels(truth, 1e-3f);
    const double error = support::compare(picture, truth, covered).rmse;
    EXPECT_LT(error, 2.5e-4);
    volume->setLookup(A::PREINTEGRATED);
    for (double period = 1.0; period > 0.03; period *= 0.8) {
        volume->setSamplingPeriod(osg::Vec3d(period, period, period));
        if (support::compare(support::renderScene(volume, view()), truth, covered).rmse <= error)
            break;
    }
    EXPECT_GT(samples(), 1.2 * fine);
}

} // namespace

} // namespace AdaptiveStepsTest
