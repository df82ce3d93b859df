// Volumes of one sample along an axis: slabs as thick as the distance to a next sample would be.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Precision.h>

#include <cmath>

namespace OneSliceTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using OneSlice = support::GLTest;

const Points LIT{{0.0, {0.1, 0.8, 0.2, 0.05}}, {1.0, {1.0, 0.3, 0.1, 0.6}}};
constexpr int WIDE = 20;
// Of a scan whose slices are far apart.
const osg::Vec3d SPACING(1.0, 1.5, 4.0);

RenderOptions view()
{
    RenderOptions options;
    options.size(72, 72).perspective(40.0).lookAt({38.0, -46.0, 33.0}, {9.5, 9.0, 9.0}, {0, 0, 1});
    options.light = true;
    return options;
}

// Samples that are the same along the axes of `thin`.
osg::ref_ptr<Voxels> makeThin(const glm::bvec3& thin, int samples)
{
    glm::ivec3 size(WIDE);
    osg::Vec3d origin(0.5, -1.0, 2.0);
    for (int axis = 0; axis < 3; ++axis)
        if (thin[axis]) {
            size[axis] = samples;
            origin[axis] -= 0.5 * (samples - 1) * SPACING[axis];
        }
    osg::ref_ptr<Voxels> voxels = makeVoxels(size, [&](glm::dvec3 p) {
        for (int axis = 0; axis < 3; ++axis)
            if (thin[axis]) p[axis] = 0.0;
        return bumps(p);
    });
    voxels->setSpacing(SPACING);
    voxels->setOrigin(origin);
    return voxels;
}

FloatImage picture(Voxels* voxels, const std::function<void(VolumeAppearance&)>& with,
                   const RenderOptions& options = view())
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(LIT));
    volume->setOpacityUnit(2.0);
    support::filterExactly(*volume); // weights are rounded elsewhere in a texture twice as deep
    with(*volume);
    return support::renderScene(volume, options);
}

// Two equal slices half a spacing before and behind are the same slab by definition.
void expectSameSlab(const std::function<void(VolumeAppearance&)>& with, const std::string& what)
{
    for (const glm::bvec3& thin :
         {glm::bvec3(true, false, false), glm::bvec3(false, true, false),
          glm::bvec3(false, false, true), glm::bvec3(false, true, true), glm::bvec3(true)}) {
        const FloatImage one = picture(makeThin(thin, 1), with);
        const FloatImage two = picture(makeThin(thin, 2), with);
        const std::string where = what + ", thin along " + (thin.x ? "x" : "") +
                                  (thin.y ? "y" : "") + (thin.z ? "z" : "");
        // A single voxel of 1 x 1.5 x 4 is a few pixels large.
        EXPECT_GT(support::coveredPixels(one, 0.02f).count(), 4u) << where;
        EXPECT_LT(support::compare(one, two).maximum, 1e-4) << where;
    }
}

TEST_F(OneSlice, IsTheSlabBetweenTwoThatAreEqual)
{
    for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES})
        for (const auto interpolation :
             {VolumeAppearance::NEAREST, VolumeAppearance::LINEAR, VolumeAppearance::CUBIC})
            expectSameSlab(
                [&](VolumeAppearance& volume) {
                    volume.setTechnique(technique);
                    volume.setInterpolation(interpolation);
                },
                "technique " + std::to_string(technique) + ", interpolation " +
                    std::to_string(interpolation));
}

TEST_F(OneSlice, WhateverItsRayFunctionAndLight)
{
    for (const auto ray : {VolumeAppearance::MAXIMUM, VolumeAppearance::MINIMUM,
                           VolumeAppearance::AVERAGE, VolumeAppearance::SUM})
        expectSameSlab([&](VolumeAppearance& volume) { volume.setRayFunction(ray); },
                       "ray function " + std::to_string(ray));
    expectSameSlab([](VolumeAppearance& volume) { volume.setShading(true); }, "lit");
}

TEST_F(OneSlice, HasTheOpacityOfItsThickness)
{
    osg::ref_ptr<Voxels> voxels = makeThin(glm::bvec3(false, false, true), 1);
    RenderOptions options = view();
    options.orthographic(20.0).lookAt({9.5, 14.0, 60.0}, {9.5, 14.0, 2.0}, {0, 1, 0});
    const FloatImage image = picture(
        voxels,
        [](VolumeAppearance& volume) {
            volume.setLookupTable(makeTable(constantPoints({0.2, 0.4, 0.6, 0.3})));
        },
        options);
    const double opacity = 1.0 - std::pow(1.0 - 0.3, 4.0 / 2.0);
    EXPECT_NEAR(image.at(36, 36).a, opacity, 1e-5);
    EXPECT_NEAR(image.at(36, 36).b, 0.6 * opacity, 1e-5);
    EXPECT_EQ(image.at(1, 1).a, 0.0f);
}

TEST_F(OneSlice, OfManyBricksIsThatOfOne)
{
    const glm::bvec3 thin(false, false, true);
    const auto plain = [](VolumeAppearance&) {};
    const FloatImage one = picture(makeThin(thin, 1), plain);
    for (const bool joined : {true, false}) {
        osg::ref_ptr<Voxels> bricks = makeThin(thin, 1);
        ASSERT_TRUE(bricks->setBrickSize({8, 8, 8}));
        ASSERT_EQ(bricks->getLayout().brickCount(), 9);
        const FloatImage many = picture(bricks, plain, support::joining(view(), joined));
        EXPECT_LT(support::compare(many, one).maximum, 1e-4) << joined;
    }
}

TEST_F(OneSlice, ShowsWhatItsTableDoesNotHide)
{
    // Only the brightest part of the slice is above zero: empty cells are leapt over.
    osg::ref_ptr<LookupTable> table =
        makeTable({{0.0, {1, 1, 1, 0}}, {0.7, {1, 1, 1, 0}}, {1.0, {1, 0.5, 0, 0.9}}});
    expectSameSlab([&](VolumeAppearance& volume) { volume.setLookupTable(table); }, "hidden");
}

} // namespace

} // namespace OneSliceTest
