// Between samples: nearest, linear, cubic, and how exact the device's filter is.

#include "Volumes.h"

#include <osgVolumizer/Error.h>

#include <support/GLTest.h>

#include <cmath>

namespace InterpolationTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using Interpolation = support::GLTest;

const Points RAMP{{0.0, {0.1, 0.8, 0.2, 0.02}}, {1.0, {1.0, 0.3, 0.1, 0.3}}};

RenderOptions view(double size)
{
    RenderOptions options;
    const double c = 0.5 * (size - 1.0);
    options.size(80, 80).perspective(40.0).lookAt(
        osg::Vec3d(c + 1.6 * size, c - 2.0 * size, c + 1.3 * size), {c, c, c}, {0, 0, 1});
    return options;
}

FloatImage expectedPicture(const Voxels& voxels, std::shared_ptr<oracle::Grid> grid,
                           const RenderOptions& options)
{
    oracle::Scene scene = oracleScene(
        oracle::voxelVolume(std::move(grid), voxels.getLayout().size(), oracle::Table(RAMP)));
    scene.tolerance = 1e-8;
    return oraclePicture(scene, options);
}

double rmse(VolumeAppearance& volume, const RenderOptions& options, const FloatImage& expected,
            double period)
{
    volume.setSamplingPeriod(osg::Vec3d(period, period, period));
    return support::compare(support::renderScene(&volume, options), expected).rmse;
}

// The same field as integers of a type, over the type's range.
osg::ref_ptr<Voxels> makeIntegers(const glm::ivec3& size, VoxelType type)
{
    VoxelSource::Description description;
    description.size = size;
    description.type = type;
    const double highest = type == VoxelType::UINT8 ? 255.0 : 65535.0;
    std::vector<double> values;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                values.push_back(highest * bumps(glm::dvec3(x, y, z)));
    const auto bytes = oracle::fromDoubles(values, type);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    std::copy(bytes.begin(), bytes.end(), static_cast<unsigned char*>(source->data()));
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    voxels->setRange(osg::Vec2d(0.0, highest));
    return voxels;
}

TEST_F(Interpolation, EachKindConvergesToItsOwnIntegral)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(17, 15, 19), bumps);
    const RenderOptions options = view(17);
    const std::pair<VolumeAppearance::Interpolation, oracle::Grid::Interpolation> kinds[] = {
        {VolumeAppearance::NEAREST, oracle::Grid::NEAREST},
        {VolumeAppearance::LINEAR, oracle::Grid::LINEAR},
        {VolumeAppearance::CUBIC, oracle::Grid::CUBIC}};
    for (const auto& kind : kinds) {
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
        volume->setLookupTable(makeTable(RAMP));
        volume->setInterpolation(kind.first);
        const FloatImage expected = expectedPicture(*voxels, gridOf(*voxels, kind.second), options);
        const double coarse = rmse(*volume, options, expected, 1.0);
        const double fine = rmse(*volume, options, expected, 0.25);
        // Nearest is not continuous: first order along the ray.
        const bool nearest = kind.first == VolumeAppearance::NEAREST;
        EXPECT_LT(fine, nearest ? 2e-3 : 5e-5);
        EXPECT_LT(fine, (nearest ? 0.4 : 0.1) * coarse);
    }
}

TEST_F(Interpolation, CubicComesThirdOrderNearerToASmoothField)
{
    // Voxels of half the size: an eighth of the error, and less than linear interpolation leaves.
    const auto field = [](const glm::dvec3& p) { return std::exp(-glm::dot(p, p) / 0.1); };
    double errors[2][2];
    for (int level = 0; level < 2; ++level) {
        const int n = level == 0 ? 17 : 33;
        const double scale = 2.0 / (n - 1);
        osg::ref_ptr<Voxels> voxels =
            makeVoxels(glm::ivec3(n), [&](const glm::dvec3& p) { return field(p * scale - 1.0); });
        voxels->setSpacing(osg::Vec3d(scale, scale, scale));
        voxels->setOrigin(osg::Vec3d(-1, -1, -1));
        oracle::Volume volume = oracle::boxVolume(
            std::make_shared<oracle::GaussianField>(glm::dvec3(0.0), std::sqrt(0.05)),
            core::Box3d{glm::dvec3(-1.0), glm::dvec3(1.0)}, oracle::Table(RAMP), 0.1);
        RenderOptions options;
        options.size(64, 64).perspective(40.0).lookAt({3, -4, 2.5}, {0, 0, 0}, {0, 0, 1});
        const FloatImage expected = oraclePicture(oracleScene(volume), options);
        for (int cubic = 0; cubic < 2; ++cubic) {
            osg::ref_ptr<VolumeAppearance> node = makeVolume(voxels);
            node->setLookupTable(makeTable(RAMP));
            node->setOpacityUnit(0.1);
            node->setInterpolation(cubic ? VolumeAppearance::CUBIC : VolumeAppearance::LINEAR);
            errors[cubic][level] = rmse(*node, options, expected, 0.125);
        }
    }
    EXPECT_GT(std::log2(errors[0][0] / errors[0][1]), 1.8);
    EXPECT_GT(std::log2(errors[1][0] / errors[1][1]), 2.7);
    EXPECT_LT(errors[1][1], 0.3 * errors[0][1]);
}

TEST_F(Interpolation, ExactFilteringIsExactForEveryType)
{
    for (const VoxelType type : {VoxelType::UINT8, VoxelType::UINT16}) {
        osg::ref_ptr<Voxels> voxels = makeIntegers(glm::ivec3(17), type);
        const double highest = voxels->getRange().y();
        const auto block = voxels->getBrick(0);
        std::vector<double> samples = oracle::toDoubles(block.data, 17 * 17 * 17, type);
        for (double& s : samples)
            s /= highest;
        const RenderOptions options = view(17);
        const FloatImage expected = expectedPicture(
            *voxels, std::make_shared<oracle::Grid>(glm::ivec3(17), samples), options);
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
        volume->setLookupTable(makeTable(RAMP));
        volume->setExactFiltering(true);
        EXPECT_LT(rmse(*volume, options, expected, 0.125), 1e-5);
        volume->setExactFiltering(false);
        EXPECT_LT(rmse(*volume, options, expected, 0.125), 1e-3);
    }
}

TEST_F(Interpolation, BricksShowNoSeams)
{
    osg::ref_ptr<Voxels> whole = makeVoxels(glm::ivec3(33), bumps);
    const RenderOptions options = view(33);
    for (const auto kind :
         {VolumeAppearance::NEAREST, VolumeAppearance::LINEAR, VolumeAppearance::CUBIC}) {
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(whole);
        volume->setLookupTable(makeTable(RAMP));
        volume->setInterpolation(kind);
        volume->setSamplingPeriod(osg::Vec3d(0.25, 0.25, 0.25));
        const FloatImage one = support::renderScene(volume, options);
        osg::ref_ptr<Voxels> bricks = makeVoxels(glm::ivec3(33), bumps);
        bricks->setBrickSize({17, 17, 17});
        bricks->setOverlap(volume->getRequiredOverlap());
        volume->setVoxels(bricks);
        for (const bool joined : {true, false}) {
            const FloatImage image =
                support::renderScene(volume, support::joining(options, joined));
            const auto d = support::compare(image, one);
            EXPECT_LT(d.rmse, kind == VolumeAppearance::NEAREST ? 2e-3 : 1e-5) << kind;
        }
    }
}

TEST_F(Interpolation, CubicWithTooLittleOverlapSaysSoAndIsLinear)
{
    osg::ref_ptr<Voxels> bricks = makeVoxels(glm::ivec3(33), bumps);
    bricks->setBrickSize({17, 17, 17});
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(bricks);
    volume->setName("too little");
    const FloatImage linear = support::renderScene(volume, view(33));
    volume->setInterpolation(VolumeAppearance::CUBIC);
    ASSERT_TRUE(bricks->setOverlap(1));
    clearLastError();
    const FloatImage cubic = support::renderScene(volume, view(33));
    EXPECT_EQ(support::compare(cubic, linear).maximum, 0.0);
    EXPECT_EQ(getLastError().code, ErrorCode::NOT_SUPPORTED);
    EXPECT_NE(getLastError().text.find("too little"), std::string::npos);
    EXPECT_NE(getLastError().text.find("overlap is 1"), std::string::npos);
}

TEST_F(Interpolation, TheOverlapThatIsNeededIsChosen)
{
    for (const bool voxelsFirst : {true, false}) {
        osg::ref_ptr<Voxels> bricks = makeVoxels(glm::ivec3(33), bumps);
        bricks->setBrickSize({17, 17, 17});
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(bricks);
        if (!voxelsFirst) volume->setVoxels(nullptr);
        volume->setInterpolation(VolumeAppearance::CUBIC);
        volume->setShading(true);
        volume->setVoxels(bricks);
        EXPECT_EQ(bricks->getOverlap(), 5);
        clearLastError();
        const FloatImage many = support::renderScene(volume, support::joining(view(33), false));
        EXPECT_TRUE(getLastError().ok()) << getLastError().text;
        volume->setVoxels(makeVoxels(glm::ivec3(33), bumps));
        EXPECT_LT(support::compare(many, support::renderScene(volume, view(33))).rmse, 1e-4);
    }
}

} // namespace

} // namespace InterpolationTest
