// Every family of sampling surfaces shows the same volume.

#include "Volumes.h"

#include <support/GLTest.h>

namespace SamplingTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

RenderOptions perspectiveView()
{
    return RenderOptions().size(80, 80).perspective(60.0).lookAt({42, -12, 34}, {14, 10, 12},
                                                                 {0, 0, 1});
}

RenderOptions orthographicView()
{
    return RenderOptions().size(80, 80).orthographic(22.0).lookAt({42, -12, 34}, {14, 10, 12},
                                                                  {0, 0, 1});
}

struct Family
{
    SamplingMode mode;
    SamplingSpace space;
};

std::string familyName(const ::testing::TestParamInfo<Family>& info)
{
    static const char* modes[] = {"Viewport", "Axis", "Spheres"};
    static const char* spaces[] = {"ViewVolume", "Object", "Primitive"};
    return std::string(modes[int(info.param.mode)]) + spaces[int(info.param.space)];
}

class Sampling : public support::GLTest, public ::testing::WithParamInterface<Family>
{
};

TEST_P(Sampling, AgreesWithTheOracle)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels({29, 21, 25}, bumps);
    ASSERT_TRUE(voxels->setBrickSize({15, 15, 15}));
    TwinVolume twin = makeTwin(voxels, smoothPoints(0.04), VolumeAppearance::SLICES);
    twin.node->setSamplingMode(GetParam().mode);
    twin.node->setSamplingSpace(GetParam().space);
    for (const RenderOptions& options : {perspectiveView(), orthographicView()}) {
        const FloatImage expected = oraclePicture(oracleScene(twin.oracle), options);
        std::vector<double> steps, errors;
        for (double period = 1.0; period > 0.2; period *= 0.5) {
            twin.setPeriod(period);
            const FloatImage image = support::renderScene(twin.node, options);
            steps.push_back(period);
            errors.push_back(compare(image, expected).rmse);
            if (period == 1.0)
                support::savePicture(image, "sampling_" + familyName({GetParam(), 0}));
        }
        EXPECT_LE(errors.back(), 2e-3);
        EXPECT_GE(support::convergenceOrder(steps, errors), 0.9)
            << errors[0] << " " << errors[1] << " " << errors[2];
    }
}

INSTANTIATE_TEST_SUITE_P(
    Families, Sampling,
    ::testing::Values(Family{SamplingMode::VIEWPORT_ALIGNED, SamplingSpace::VIEW_VOLUME},
                      Family{SamplingMode::VIEWPORT_ALIGNED, SamplingSpace::OBJECT},
                      Family{SamplingMode::VIEWPORT_ALIGNED, SamplingSpace::PRIMITIVE},
                      Family{SamplingMode::AXIS_ALIGNED, SamplingSpace::VIEW_VOLUME},
                      Family{SamplingMode::AXIS_ALIGNED, SamplingSpace::OBJECT},
                      Family{SamplingMode::AXIS_ALIGNED, SamplingSpace::PRIMITIVE},
                      Family{SamplingMode::SPHERICAL, SamplingSpace::VIEW_VOLUME},
                      Family{SamplingMode::SPHERICAL, SamplingSpace::OBJECT},
                      Family{SamplingMode::SPHERICAL, SamplingSpace::PRIMITIVE}),
    familyName);

class Periods : public support::GLTest,
                public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _twin = makeTwin(makeVoxels({25, 25, 25}, bumps), smoothPoints(0.1), GetParam());
    }

    // Along x for 0, y for 1.
    FloatImage lookAlong(int axis, const osg::Vec3d& period)
    {
        _twin.node->setSamplingPeriod(period);
        const osg::Vec3d eye = axis == 0 ? osg::Vec3d(60, 12, 12) : osg::Vec3d(12, 60, 12);
        return support::renderScene(
            _twin.node,
            RenderOptions().size(64, 64).orthographic(14.1).lookAt(eye, {12, 12, 12}, {0, 0, 1}));
    }

    TwinVolume _twin;
};

TEST_P(Periods, CountAlongTheirOwnAxis)
{
    const FloatImage fine = lookAlong(0, {0.5, 0.5, 0.5}), coarse = lookAlong(0, {4, 4, 4});
    EXPECT_GT(compare(fine, coarse).maximum, 1e-3);
    EXPECT_LT(compare(lookAlong(0, {0.5, 4, 4}), fine).maximum, 1e-6);
    EXPECT_LT(compare(lookAlong(0, {4, 0.5, 0.5}), coarse).maximum, 1e-6);
    EXPECT_LT(compare(lookAlong(1, {4, 0.5, 4}), lookAlong(1, {0.5, 0.5, 0.5})).maximum, 1e-6);
    EXPECT_LT(compare(lookAlong(1, {0.5, 4, 0.5}), lookAlong(1, {4, 4, 4})).maximum, 1e-6);
}

TEST_P(Periods, CountInVoxelsNotInUnits)
{
    // Halved spacing and opacity unit: the same volume, half as large.
    const FloatImage expected = lookAlong(0, {2, 2, 2});
    Voxels* voxels = _twin.node->getVoxels();
    ASSERT_TRUE(voxels->setSpacing({0.5, 0.5, 0.5}));
    _twin.node->setChild(0, VolumeGeometry::createBox(*voxels));
    const FloatImage image = support::renderScene(
        _twin.node,
        RenderOptions().size(64, 64).orthographic(7.05).lookAt({30, 6, 6}, {6, 6, 6}, {0, 0, 1}));
    EXPECT_LT(compare(image, expected).maximum, 1e-5);
}

TEST_P(Periods, GrowToKeepWithinTheMaximum)
{
    ASSERT_TRUE(_twin.node->setMaximumSamples(12));
    const FloatImage bounded = lookAlong(0, {0.01, 0.01, 0.01});
    ASSERT_TRUE(_twin.node->setMaximumSamples(4096));
    EXPECT_LT(compare(lookAlong(0, {2, 2, 2}), bounded).maximum, 1e-5);
}

TEST_P(Periods, OpacityUnitScalesTheOpticalDepth)
{
    // A unit twice as long is a table of half the extinction.
    const double alpha = 0.2;
    _twin.node->setLookupTable(makeTable(constantPoints({1.0, 0.5, 0.2, alpha})));
    ASSERT_TRUE(_twin.node->setOpacityUnit(2.0));
    const FloatImage unit = lookAlong(0, {1, 1, 1});
    ASSERT_TRUE(_twin.node->setOpacityUnit(0.0));
    _twin.node->setLookupTable(
        makeTable(constantPoints({1.0, 0.5, 0.2, 1.0 - std::sqrt(1.0 - alpha)})));
    EXPECT_LT(compare(lookAlong(0, {1, 1, 1}), unit).maximum, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Techniques, Periods,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

using Interpolation = support::GLTest;

TEST_F(Interpolation, NearestShowsCubes)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels({9, 9, 9}, bumps);
    ASSERT_TRUE(voxels->setBrickSize({5, 5, 5}));
    TwinVolume twin = makeTwin(voxels, smoothPoints(0.3), VolumeAppearance::SLABS);
    twin.node->setInterpolation(VolumeAppearance::NEAREST);
    twin.oracle.field = gridOf(*voxels, oracle::Grid::NEAREST);
    twin.setPeriod(0.05);
    const RenderOptions options =
        RenderOptions().size(80, 80).perspective(40.0).lookAt({16, -7, 14}, {4, 4, 4}, {0, 0, 1});
    const FloatImage image = support::renderScene(twin.node, options);
    support::savePicture(image, "interpolation_nearest");
    const support::Difference d = compare(image, oraclePicture(oracleScene(twin.oracle), options));
    EXPECT_LT(d.rmse, 2e-3);
}

} // namespace

} // namespace SamplingTest
