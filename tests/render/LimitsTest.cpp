// Contexts that can do less, mocked, and targets of fewer bits.

#include "Volumes.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/render/context/ContextLimits.h>

#include <support/GLTest.h>
#include <support/Shapes.h>

#include <cmath>

namespace LimitsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using render::ContextLimits;
using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;

namespace {

class Limits : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _twin =
            makeTwin(makeVoxels({25, 21, 17}, bumps), smoothPoints(0.1), VolumeAppearance::SLICES);
        _twin.setPeriod(0.1);
        clearLastError();
    }

    // An 8-bit framebuffer, so that what is more comes from our own target.
    static RenderOptions view()
    {
        RenderOptions options = RenderOptions().size(80, 80).perspective(45.0).lookAt(
            {40, -20, 30}, {12, 10, 8}, {0, 0, 1});
        options.format = PictureTarget::BYTE;
        return options;
    }
    static RenderOptions smallTextures()
    {
        return support::limited(view(), [](ContextLimits& limits) { limits.texture3DSize = 13; });
    }
    FloatImage exact() const
    {
        RenderOptions options = view();
        options.format = PictureTarget::FLOAT32;
        return support::renderScene(_twin.node, options);
    }

    TwinVolume _twin;
};

// The same values as voxels of another type.
osg::ref_ptr<Voxels> typed(const Voxels& voxels, VoxelType type)
{
    const double top = type == VoxelType::UINT8 ? 255.0 : 1.0;
    auto* floats = dynamic_cast<MemoryVoxelSource*>(voxels.getSource());
    VoxelSource::Description description = floats->describe();
    description.type = type;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    const glm::ivec3 size = voxels.getLayout().size();
    core::convertVoxels(floats->data(), VoxelType::FLOAT32, source->data(), type,
                        std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z), top);
    osg::ref_ptr<Voxels> result = new Voxels(source);
    result->setRange(osg::Vec2d(0.0, top));
    return result;
}

bool lastErrorNames(const std::string& words)
{
    return getLastError().code == ErrorCode::NOT_SUPPORTED &&
           getLastError().text.find(words) != std::string::npos;
}

} // namespace

TEST_F(Limits, BitsOfTheTargetAreThoseAskedFor)
{
    const FloatImage expected = exact();
    double errors[3] = {};
    for (const int i : {0, 1, 2}) {
        ASSERT_TRUE(_twin.node->setAccumulationBits(8 << i).ok());
        errors[i] = compare(support::renderScene(_twin.node, view()), expected).maximum;
    }
    // Some 250 blends, each rounded to 8 bits, or to half precision's 11 (some rasterisers cut
    // instead); or all of them once at the end.
    EXPECT_GT(errors[0], errors[1]);
    EXPECT_LT(errors[1], 250.0 * std::ldexp(1.0, -11));
    EXPECT_GT(errors[1], 1.0 / 255.0);
    EXPECT_LE(errors[2], 0.5 / 255.0 + 1e-4);
}

TEST_F(Limits, WithoutFloatTargetsFixedPointIsUsed)
{
    const FloatImage expected = exact();
    const FloatImage image = support::renderScene(
        _twin.node,
        support::limited(view(), [](ContextLimits& limits) { limits.floatTargets = false; }));
    EXPECT_TRUE(lastErrorNames("no float targets")) << getLastError().text;
    // 250 blends, each off by at most half of 1/65535, and the framebuffer's own rounding.
    EXPECT_LE(compare(image, expected).maximum, 0.5 / 255.0 + 250 * 0.5 / 65535.0);
}

TEST_F(Limits, WithoutWhatVolumesNeedTheRestIsShown)
{
    const osg::ref_ptr<osg::Node> quad = support::makeQuad(
        {osg::Vec3(-5, 2, -5), {30, 8, 2}, {28, 14, 20}, {-4, 12, 18}}, {0.2f, 0.7f, 0.3f, 1.0f});
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(_twin.node);
    scene->addChild(quad);
    const FloatImage rest = support::renderScene(quad, view());
    const std::pair<const char*, void (*)(ContextLimits&)> lacks[] = {
        {"OpenGL 2.1", [](ContextLimits& limits) { limits.version = 2.1; }},
        {"no 3D textures", [](ContextLimits& limits) { limits.texture3DSize = 0; }}};
    for (const auto& lack : lacks) {
        const FloatImage image = support::renderScene(scene, support::limited(view(), lack.second));
        EXPECT_EQ(compare(image, rest).maximum, 0.0);
        EXPECT_TRUE(lastErrorNames(lack.first)) << getLastError().text;
    }
}

TEST_F(Limits, BricksLargerThanTexturesAreDrawnCoarser)
{
    const auto linear = [](const glm::dvec3& p) { return 0.02 * p.x + 0.015 * p.y + 0.01 * p.z; };
    const auto cubic = [](const glm::dvec3& p) {
        return bumps(glm::dvec3(0.3) * p + glm::dvec3(1.0));
    };
    for (const VoxelType type : {VoxelType::FLOAT32, VoxelType::UINT8, VoxelType::HALF}) {
        const auto volume = [&](const std::function<double(const glm::dvec3&)>& value) {
            osg::ref_ptr<Voxels> voxels = typed(*makeVoxels({25, 21, 17}, value), type);
            EXPECT_TRUE(voxels->setBrickSize({32, 32, 32}).ok());
            osg::ref_ptr<VolumeAppearance> node = makeVolume(voxels);
            node->setLookupTable(makeTable(smoothPoints(0.1)));
            node->setTechnique(VolumeAppearance::SLABS);
            return node;
        };
        const osg::ref_ptr<VolumeAppearance> straight = volume(linear), bent = volume(cubic);
        const FloatImage exactStraight = support::renderScene(straight, view());
        const FloatImage exactBent = support::renderScene(bent, view());
        // What varies linearly loses nothing; 8-bit voxels are rounded and so are no more linear.
        const double rounding = type == VoxelType::UINT8 ? 3e-3 : 1e-3;
        EXPECT_LE(compare(support::renderScene(straight, smallTextures()), exactStraight).maximum,
                  1.0 / 255.0 + rounding);
        EXPECT_TRUE(lastErrorNames("25,21,17 voxels")) << getLastError().text;
        EXPECT_LE(compare(support::renderScene(bent, smallTextures()), exactBent).rmse, 4e-3);
    }
}

TEST_F(Limits, PaintLargerThanTexturesIsCoarserToo)
{
    const auto linear = [](const glm::dvec3& p) { return 0.02 * p.x + 0.015 * p.y + 0.01 * p.z; };
    osg::ref_ptr<Voxels> voxels = makeVoxels({23, 21, 17}, linear);
    ASSERT_TRUE(voxels->setBrickSize({32, 32, 32}).ok());
    osg::ref_ptr<VolumeAppearance> paint = makeVolume(voxels);
    paint->setLookupTable(makeTable(smoothPoints(0.9)));
    paint->setCombineRule(VolumeAppearance::PAINT);
    osg::ref_ptr<VolumeAppearance> painted = makeVolume(makeVoxels({12, 12, 12}, bumps));
    painted->setLookupTable(makeTable(smoothPoints(0.3)));
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(painted);
    const FloatImage plain = support::renderScene(scene, view());
    scene->addChild(paint);
    const FloatImage expected = support::renderScene(scene, view());
    EXPECT_GT(compare(expected, plain).maximum, 0.05);
    EXPECT_LE(compare(support::renderScene(scene, smallTextures()), expected).maximum,
              1.0 / 255.0 + 1e-3);
    EXPECT_TRUE(lastErrorNames("23,21,17 voxels")) << getLastError().text;
}

} // namespace LimitsTest
