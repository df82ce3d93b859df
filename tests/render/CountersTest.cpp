// Nothing is read, cut or uploaded that is not seen, or that is there already.

#include "Volumes.h"

#include <osgVolumizer/core/voxels/VoxelData.h>

#include <support/GLTest.h>
#include <support/Shapes.h>

#include <osg/Depth>
#include <osg/Group>

#include <atomic>
#include <mutex>
#include <set>

namespace CountersTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33, BRICK = 9; // 64 bricks
const std::size_t BRICK_BYTES = BRICK * BRICK * BRICK * sizeof(float);

RenderOptions view()
{
    return RenderOptions().size(64, 64).perspective(45.0).lookAt({60, -36, 50}, {16, 16, 16},
                                                                 {0, 0, 1});
}

// Knows the range of every region without reading it; notes what is read.
class KnowingSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, KnowingSource)

        KnowingSource() = default;
    KnowingSource(const KnowingSource& o, const osg::CopyOp& op) : VoxelSource(o, op) {}

    // 1 in the brick whose corner is here, 0 elsewhere.
    static bool full(const glm::ivec3& p)
    {
        return p.x > 10 && p.x < 15 && p.y > 18 && p.y < 23 && p.z > 2 && p.z < 7;
    }

    Description describe() const override
    {
        Description d;
        d.size = glm::ivec3(SIZE);
        d.type = VoxelType::FLOAT32;
        return d;
    }
    Status read(const core::Box3i& region, void* destination) const override
    {
        ++reads;
        auto* out = static_cast<float*>(destination);
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    *out++ = full({x, y, z}) ? 1.0f : 0.0f;
        return {};
    }
    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override
    {
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    if (full({x, y, z})) return std::make_pair(0.0, 1.0);
        return std::make_pair(0.0, 0.0);
    }

    mutable std::atomic<int> reads{0};
};

class Counters : public support::GLTest,
                 public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _voxels = makeVoxels(glm::ivec3(SIZE), bumps);
        ASSERT_TRUE(_voxels->setBrickSize({BRICK, BRICK, BRICK}));
        _twin = makeTwin(_voxels, smoothPoints(0.05), GetParam());
    }

    // A counter of the last frame; 0 where it was not counted.
    static double value(const support::SceneRenderer& renderer, const std::string& name)
    {
        const auto counters = renderer.counters();
        const auto found = counters.find("osgVolumizer " + name);
        return found == counters.end() ? 0.0 : found->second;
    }

    osg::ref_ptr<Voxels> _voxels;
    TwinVolume _twin;
};

TEST_P(Counters, NothingIsUploadedTwice)
{
    support::SceneRenderer renderer(_twin.node, view());
    renderer.render();
    EXPECT_EQ(value(renderer, "bricks total"), 64);
    EXPECT_EQ(value(renderer, "bricks drawn"), 64);
    EXPECT_EQ(value(renderer, "bricks uploaded"), 64);
    EXPECT_EQ(value(renderer, "bytes uploaded"), 64.0 * BRICK_BYTES);
    EXPECT_GT(value(renderer, "faces"), 0);
    EXPECT_GT(value(renderer, "polygons"), 0);
    EXPECT_EQ(_voxels->getReadCount(), 64u);

    renderer.render();
    EXPECT_EQ(value(renderer, "bricks drawn"), 64);
    EXPECT_EQ(value(renderer, "bricks uploaded"), 0);
    EXPECT_EQ(value(renderer, "bytes uploaded"), 0);

    // Another view, another table, another period: nothing of this touches the voxels.
    renderer.options().lookAt({-40, 50, 10}, {16, 16, 16}, {0, 0, 1});
    ASSERT_TRUE(
        _twin.node->getLookupTable()->setPoints(smoothPoints(0.2), LookupTable::RANGE_FRACTION));
    _twin.setPeriod(0.5);
    renderer.render();
    EXPECT_EQ(value(renderer, "bricks drawn"), 64);
    EXPECT_EQ(value(renderer, "bricks uploaded"), 0);
    EXPECT_EQ(_voxels->getReadCount(), 64u);
}

TEST_P(Counters, ChangedBricksAreUploadedAlone)
{
    support::SceneRenderer renderer(_twin.node, view());
    const FloatImage before = renderer.render();
    // A brick in the middle of the nearest face, changed in place.
    const std::int64_t brick = 64 / 2;
    const core::Box3i region = _voxels->getLayout().brick(brick).samples;
    auto* source = static_cast<MemoryVoxelSource*>(_voxels->getSource());
    auto* data = static_cast<float*>(source->data());
    for (int z = region.min.z + 1; z + 1 < region.max.z; ++z)
        for (int y = region.min.y + 1; y + 1 < region.max.y; ++y)
            for (int x = region.min.x + 1; x + 1 < region.max.x; ++x)
                data[x + SIZE * (y + SIZE * z)] = 0.0f;
    _voxels->dirty(brick);
    const FloatImage after = renderer.render();
    EXPECT_EQ(value(renderer, "bricks uploaded"), 1);
    EXPECT_EQ(value(renderer, "bytes uploaded"), double(BRICK_BYTES));
    EXPECT_GT(compare(after, before).maximum, 1e-3);
    TwinVolume fresh = makeTwin(_voxels, smoothPoints(0.05), GetParam());
    EXPECT_LE(compare(after, support::renderScene(fresh.node, view())).maximum, 1e-6);
}

TEST_P(Counters, TransparentBricksAreNeitherReadNorUploaded)
{
    osg::ref_ptr<KnowingSource> source = new KnowingSource;
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    ASSERT_TRUE(voxels->setRange(osg::Vec2d(0.0, 1.0)));
    ASSERT_TRUE(voxels->setBrickSize({BRICK, BRICK, BRICK}));
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setTechnique(GetParam());
    volume->setLookupTable(makeTable(smoothPoints(0.3)));
    support::SceneRenderer renderer(volume, view());
    const FloatImage image = renderer.render();
    EXPECT_GT(support::coveredPixels(image, 0.2f).count(), 10u);
    EXPECT_EQ(value(renderer, "bricks drawn"), 1);
    EXPECT_EQ(value(renderer, "bricks uploaded"), 1);
    EXPECT_EQ(source->reads, 1);

    // All of it under a table that shows low values.
    volume->setLookupTable(makeTable({{0.0, {1, 1, 1, 0.01}}, {1.0, {1, 1, 1, 0.0}}}));
    renderer.render();
    EXPECT_EQ(value(renderer, "bricks drawn"), 64);
    EXPECT_EQ(value(renderer, "bricks uploaded"), 63);
    EXPECT_EQ(source->reads, 64);

    // Nothing of it.
    volume->setLookupTable(makeTable({{0.0, {1, 1, 1, 0.0}}, {1.0, {1, 1, 1, 0.0}}}));
    EXPECT_EQ(support::coveredPixels(renderer.render()).count(), 0u);
    EXPECT_EQ(value(renderer, "bricks drawn"), 0);
}

TEST_P(Counters, OutsideTheViewCostsNothing)
{
    RenderOptions options = view();
    options.lookAt({60, -36, 50}, {120, -80, 90}, {0, 0, 1});
    support::SceneRenderer renderer(_twin.node, options);
    EXPECT_EQ(support::coveredPixels(renderer.render()).count(), 0u);
    EXPECT_EQ(value(renderer, "bricks drawn"), 0);
    EXPECT_EQ(value(renderer, "bricks uploaded"), 0);
    EXPECT_EQ(value(renderer, "polygonizations"), 0);
    EXPECT_EQ(value(renderer, "faces"), 0);
    EXPECT_EQ(_voxels->getReadCount(), 0u);
}

TEST_P(Counters, BricksOutsideTheViewAreNotUploaded)
{
    // A view of one corner.
    RenderOptions options = view();
    options.perspective(8.0).lookAt({60, -36, 40}, {31, 1, 31}, {0, 0, 1});
    support::SceneRenderer renderer(_twin.node, options);
    EXPECT_GT(support::coveredPixels(renderer.render()).count(), 500u);
    EXPECT_GT(value(renderer, "bricks drawn"), 0);
    EXPECT_LT(value(renderer, "bricks drawn"), 24);
    EXPECT_EQ(value(renderer, "bricks uploaded"), value(renderer, "bricks drawn"));
}

TEST_P(Counters, SharedVoxelsAreUploadedOnce)
{
    // Two appearances of the same voxels, side by side.
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(_twin.node);
    TwinVolume second = makeTwin(_voxels, smoothPoints(0.2), GetParam());
    scene->addChild(second.node);
    support::SceneRenderer renderer(scene, view());
    renderer.render();
    EXPECT_EQ(value(renderer, "bricks total"), 128);
    EXPECT_EQ(value(renderer, "bricks uploaded"), 64);
}

TEST_P(Counters, OnlyWhatIsNeededOfTheFramebufferIsCopied)
{
    const double pixels = 128.0 * 128.0;
    for (const auto format : {support::PictureTarget::FLOAT32, support::PictureTarget::BYTE}) {
        const bool target = format == support::PictureTarget::BYTE;
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(_twin.node);
        RenderOptions options = view();
        options.size(128, 128).perspective(70.0);
        options.format = format;
        support::SceneRenderer renderer(scene, options);
        const FloatImage alone = renderer.render();
        EXPECT_GT(support::coveredPixels(alone, 0.2f).count(), 500u);
        // Nothing opaque, so no depth; and only the colours about the volume, there and back.
        EXPECT_EQ(value(renderer, "depths copied"), 0.0);
        const double colors = value(renderer, "colors copied");
        EXPECT_LT(colors, target ? 1.5 * pixels : 1.0);
        EXPECT_GE(colors, target ? 2.0 * double(support::coveredPixels(alone).count()) : 0.0);

        // Opaque geometry, drawn before the volume, in it: depths about the volume.
        const osg::ref_ptr<osg::Node> quad = support::makeQuad(
            {osg::Vec3(4, 16, 4), {28, 15, 4}, {28, 15, 28}, {4, 16, 28}}, {0.2f, 0.8f, 0.3f, 1});
        scene->addChild(quad);
        EXPECT_GT(compare(renderer.render(), alone).maximum, 0.1);
        EXPECT_GT(value(renderer, "depths copied"), 0.0);
        EXPECT_LT(value(renderer, "depths copied"), 0.75 * pixels);
        // What leaves no depth is as if it were not there...
        quad->getOrCreateStateSet()->setAttributeAndModes(
            new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
        renderer.render();
        EXPECT_EQ(value(renderer, "depths copied"), 0.0);
        // ...and so is what comes later.
        quad->setStateSet(nullptr);
        quad->getOrCreateStateSet()->setRenderBinDetails(20, "RenderBin");
        renderer.render();
        EXPECT_EQ(value(renderer, "depths copied"), 0.0);
        // A depth buffer that is not cleared may hold anything.
        renderer.viewer().getCamera()->setClearMask(GL_COLOR_BUFFER_BIT);
        renderer.render();
        EXPECT_GT(value(renderer, "depths copied"), 0.0);
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, Counters,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

} // namespace

} // namespace CountersTest
