// osg::Fog in volumes, against integrals in double precision.

#include "Volumes.h"

#include <osg/Fog>

#include <support/GLTest.h>
#include <support/Precision.h>

#include <algorithm>
#include <cmath>

namespace FogTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 33;
constexpr double DISTANCE = 40.0; // from the eye to the box
const glm::dvec3 FOG(0.7, 0.2, 0.9);

osg::ref_ptr<osg::Fog> fogOf(osg::Fog::Mode mode)
{
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(mode);
    fog->setColor(osg::Vec4(0.7f, 0.2f, 0.9f, 1.0f));
    fog->setDensity(0.02f);
    fog->setStart(30.0f);
    fog->setEnd(65.0f); // within the box
    return fog;
}

// A colour's share at a depth, as the OpenGL specification has it.
double shareOf(osg::Fog::Mode mode, double depth)
{
    switch (mode) {
    case osg::Fog::LINEAR:
        return std::clamp((65.0 - depth) / (65.0 - 30.0), 0.0, 1.0);
    case osg::Fog::EXP:
        return std::exp(-0.02 * depth);
    default:
        return std::exp(-0.02 * depth * 0.02 * depth);
    }
}

// Extinction at a depth in the box, the same in all layers across the view.
double extinctionAt(bool constant, double y)
{
    return constant ? 0.05 : 0.05 * (1.0 + std::sin(0.3 * y));
}

// Premultiplied light of a ray along y in fog; the midpoint rule in so many steps.
glm::dvec4 expected(osg::Fog::Mode mode, bool constant, const glm::dvec3& color)
{
    constexpr int STEPS = 20000;
    const double dy = (SIZE - 1.0) / STEPS;
    glm::dvec3 light(0.0);
    double through = 1.0;
    for (int i = 0; i < STEPS; ++i) {
        const double y = (i + 0.5) * dy, share = shareOf(mode, DISTANCE + y);
        const double next = through * std::exp(-extinctionAt(constant, y) * dy);
        light += (through - next) * glm::mix(FOG, color, share);
        through = next;
    }
    return {light, 1.0 - through};
}

// Voxels that hold opacity in place of extinction, which the table gives back.
osg::ref_ptr<A> volumeOf(bool constant, A::Technique technique, double period)
{
    const osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(SIZE), [constant](const glm::dvec3& p) {
            return 1.0 - std::exp(-extinctionAt(constant, p.y));
        });
    const osg::ref_ptr<A> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable({{0.0, {0.9, 0.6, 0.1, 0.0}}, {1.0, {0.9, 0.6, 0.1, 1.0}}}));
    volume->setTechnique(technique);
    volume->setSamplingPeriod({period, period, period});
    support::filterExactly(*volume);
    return volume;
}

// The middle of the picture, along y.
glm::dvec4 middle(osg::Node* scene, osg::Fog::Mode mode)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->getOrCreateStateSet()->setAttributeAndModes(fogOf(mode));
    root->addChild(scene);
    RenderOptions options = RenderOptions().size(9, 9).orthographic(8.0).lookAt(
        {16, -DISTANCE, 16}, {16, 16, 16}, {0, 0, 1});
    options.background = osg::Vec4();
    const FloatImage picture = support::renderScene(root, options);
    const auto pixel = picture.at(4, 4);
    return {pixel[0], pixel[1], pixel[2], pixel[3]};
}

double error(const glm::dvec4& a, const glm::dvec4& b)
{
    const glm::dvec4 d = glm::abs(a - b);
    return std::max({d.r, d.g, d.b, d.a});
}

class Fog : public support::GLTest, public ::testing::WithParamInterface<osg::Fog::Mode>
{
};

} // namespace

TEST_P(Fog, ConvergesAtSecondOrder)
{
    const glm::dvec4 exact = expected(GetParam(), false, {0.9, 0.6, 0.1});
    // What linear interpolation between voxels is off by stays; it is the same without fog.
    const glm::dvec4 finest = middle(volumeOf(false, A::SLABS, 1.0 / 32), GetParam());
    EXPECT_LT(error(finest, exact), 3e-3);
    double errors[3]; // of steps that end where voxels do
    for (int i = 0; i < 3; ++i)
        errors[i] = error(middle(volumeOf(false, A::SLABS, 1.0 / (1 << i)), GetParam()), finest);
    // The end of linear fog is a corner, which one step may meet.
    const double order = 0.5 * std::log2(errors[0] / errors[2]);
    EXPECT_GT(order, GetParam() == osg::Fog::LINEAR ? 1.7 : 1.9)
        << errors[0] << " " << errors[1] << " " << errors[2];
    EXPECT_LT(errors[2], 2e-4);
}

// Where one value fills a brick, it is still not one colour.
TEST_P(Fog, FadesBricksOfOneValue)
{
    const glm::dvec4 exact = expected(GetParam(), true, {0.9, 0.6, 0.1});
    EXPECT_LT(error(middle(volumeOf(true, A::SLABS, 0.25), GetParam()), exact), 1e-4);
    EXPECT_LT(error(middle(volumeOf(true, A::SLICES, 0.1), GetParam()), exact), 2e-3);
    const osg::ref_ptr<A> runs = volumeOf(true, A::SLABS, 0.25);
    runs->setLookup(A::PREINTEGRATED);
    EXPECT_LT(error(middle(runs, GetParam()), exact), 1e-3);
}

// Two in one place, each of half the extinction.
TEST_P(Fog, FadesVolumesThatOverlap)
{
    osg::ref_ptr<osg::Group> both = new osg::Group;
    for (int i = 0; i < 2; ++i) {
        const osg::ref_ptr<A> half = volumeOf(true, A::SLABS, 0.25);
        half->setOpacityUnit(2.0);
        both->addChild(half);
    }
    EXPECT_LT(error(middle(both, GetParam()), expected(GetParam(), true, {0.9, 0.6, 0.1})), 1e-4);
}

// An isosurface at a depth.
TEST_P(Fog, FadesIsosurfacesWhereTheyAre)
{
    const osg::ref_ptr<A> volume = makeVolume(
        makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) { return p.y / (SIZE - 1.0); }));
    volume->setLookupTable(makeTable({{0.0, {0.9, 0.6, 0.1, 1.0}}, {1.0, {0.9, 0.6, 0.1, 1.0}}}));
    volume->setRayFunction(A::ISOSURFACE);
    volume->setIsoValue(0.5);
    support::filterExactly(*volume);
    const double share = shareOf(GetParam(), DISTANCE + 16.0);
    const glm::dvec4 exact(glm::mix(FOG, {0.9, 0.6, 0.1}, share), 1.0);
    EXPECT_LT(error(middle(volume, GetParam()), exact), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Modes, Fog,
                         ::testing::Values(osg::Fog::LINEAR, osg::Fog::EXP, osg::Fog::EXP2));

} // namespace FogTest
