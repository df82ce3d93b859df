// What a picture does not need is not sampled, and leaving it out does not show.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Precision.h>

#include <osg/Geode>
#include <osg/Geometry>

#include <numeric>

namespace SkippingTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 65;

RenderOptions view()
{
    return RenderOptions().size(96, 96).perspective(40.0).lookAt({120, -90, 100}, {32, 32, 32},
                                                                 {0, 0, 1});
}

// The same view, with or without skipping.
RenderOptions skipping(const RenderOptions& options, bool on)
{
    return support::prepared(
        options, [on](osgViewer::Viewer& viewer) { support::viewHooks(viewer).skipping = on; });
}

struct SampleCounts
{
    double sum = 0.0, maximum = 0.0;
    std::vector<float> pixels;
};

SampleCounts countSamples(osg::Node* scene, const RenderOptions& options)
{
    SampleCounts counts;
    for (const auto& pixel :
         support::renderScene(scene, support::countingSamples(options)).pixels) {
        counts.pixels.push_back(pixel.r);
        counts.sum += pixel.r;
        counts.maximum = std::max(counts.maximum, double(pixel.r));
    }
    return counts;
}

// One in the middle, zero from `radius` on, and smooth between.
double ball(const glm::dvec3& p, const glm::dvec3& center, double radius)
{
    const glm::dvec3 d = (p - center) / radius;
    const double s = 1.0 - glm::dot(d, d);
    return s > 0.0 ? s * s : 0.0;
}

double middleBall(const glm::dvec3& p)
{
    return ball(p, glm::dvec3(32), 14.0);
}

// In opposite corners, so that no box around them is smaller than the volume.
double twoBalls(const glm::dvec3& p)
{
    return ball(p, glm::dvec3(12), 12.0) + ball(p, glm::dvec3(52), 12.0);
}

const Points SMOOTH{{0.0, {0.2, 0.4, 0.9, 0.0}}, {1.0, {1.0, 0.5, 0.1, 0.2}}};
const Points PEAK{{0.0, {1, 0.5, 0, 0}},
                  {0.45, {1, 0.5, 0, 0}},
                  {0.5, {1, 0.5, 0, 0.6}},
                  {0.55, {1, 0.5, 0, 0}},
                  {1.0, {0, 0, 1, 0}}};

struct Way
{
    const char* name;
    Points points;
    VolumeAppearance::Interpolation interpolation;
    VolumeAppearance::Lookup lookup;
    bool continuous; ///< else a sample that rounds to the other side of a jump shows
};

std::vector<Way> ways()
{
    using A = VolumeAppearance;
    return {{"smooth", SMOOTH, A::LINEAR, A::AFTER_INTERPOLATION, true},
            {"peak", PEAK, A::LINEAR, A::PREINTEGRATED, false},
            {"before", SMOOTH, A::LINEAR, A::BEFORE_INTERPOLATION, true},
            {"nearest", SMOOTH, A::NEAREST, A::AFTER_INTERPOLATION, false},
            {"cubic", SMOOTH, A::CUBIC, A::AFTER_INTERPOLATION, true}};
}

osg::ref_ptr<VolumeAppearance> makeVolume(Voxels* voxels, const Way& way)
{
    osg::ref_ptr<VolumeAppearance> volume = test::makeVolume(voxels);
    volume->setLookupTable(makeTable(way.points));
    volume->setInterpolation(way.interpolation);
    volume->setLookup(way.lookup);
    return volume;
}

using Skipping = support::GLTest;

} // namespace

TEST_F(Skipping, ShowsTheSame)
{
    for (const auto& field : {middleBall, twoBalls})
        for (const int brick : {SIZE, 33})
            for (const Way& way : ways()) {
                osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), field);
                ASSERT_TRUE(voxels->setOverlap(3));
                ASSERT_TRUE(voxels->setBrickSize({brick, brick, brick}));
                osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels, way);
                // Samples whose places are rounded to floats otherwise would have other weights.
                support::filterExactly(*volume);
                volume->setSamplingPeriod(osg::Vec3d(0.4, 0.4, 0.4));
                const FloatImage image = support::renderScene(volume, view());
                EXPECT_GT(support::coveredPixels(image, 0.2f).count(), 100u);
                const SampleCounts few = countSamples(volume, view());
                const RenderOptions whole = skipping(view(), false);
                const SampleCounts all = countSamples(volume, whole);
                const support::Difference d =
                    support::compare(image, support::renderScene(volume, whole));
                EXPECT_LT(way.continuous ? d.maximum : d.rmse, 1e-4)
                    << way.name << ", bricks of " << brick << ", at " << d.worstX << " "
                    << d.worstY;
                EXPECT_LT(few.sum, 0.5 * all.sum) << way.name << ", bricks of " << brick;
            }
}

TEST_F(Skipping, EmptyBordersCostNothing)
{
    osg::ref_ptr<Voxels> wide = makeVoxels(glm::ivec3(SIZE), middleBall);
    // The samples from 18 to 46 are those that are not zero.
    osg::ref_ptr<Voxels> tight = makeVoxels(
        glm::ivec3(29), [](const glm::dvec3& p) { return middleBall(p + glm::dvec3(18)); });
    ASSERT_TRUE(tight->setOrigin({18, 18, 18}));
    for (const Way& way : ways()) {
        if (way.interpolation == VolumeAppearance::CUBIC) continue; // needs a sample more each side
        const SampleCounts a = countSamples(makeVolume(wide, way), view());
        const SampleCounts b = countSamples(makeVolume(tight, way), view());
        EXPECT_LE(a.sum, 1.2 * b.sum) << way.name;
    }
}

TEST_F(Skipping, EmptyCellsAreLeaptOver)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), twoBalls);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels, ways()[0]);
    volume->setSamplingPeriod(osg::Vec3d(0.5, 0.5, 0.5));
    support::SceneRenderer renderer(volume, view());
    renderer.render();
    const auto counters = renderer.counters();
    EXPECT_GT(counters.at("osgVolumizer cells occupied"), 0.0);
    EXPECT_LT(counters.at("osgVolumizer cells occupied"),
              0.2 * counters.at("osgVolumizer cells total"));
    // Where a ray meets neither ball, no sample is taken.
    const SampleCounts counts = countSamples(volume, view());
    const FloatImage image = renderer.render();
    std::size_t none = 0;
    for (std::size_t i = 0; i < counts.pixels.size(); ++i) {
        none += counts.pixels[i] == 0.0f;
        EXPECT_TRUE(counts.pixels[i] > 0.0f || image.pixels[i].a == 0.0f) << i;
    }
    EXPECT_GT(none, counts.pixels.size() / 2);
}

TEST_F(Skipping, HomogeneousBricksAreOneSegment)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(33), [](const glm::dvec3&) { return 0.5; });
    const RenderOptions options = RenderOptions().size(64, 64).perspective(45.0).lookAt(
        {60, -36, 50}, {16, 16, 16}, {0, 0, 1});
    for (const auto lookup :
         {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::PREINTEGRATED}) {
        TwinVolume twin = makeTwin(voxels, smoothPoints(0.1));
        twin.node->setLookup(lookup);
        const FloatImage expected = oraclePicture(oracleScene(twin.oracle), options);
        for (const int brick : {33, 9}) {
            ASSERT_TRUE(voxels->setBrickSize({brick, brick, brick}));
            support::SceneRenderer renderer(twin.node, options);
            EXPECT_LT(support::compare(renderer.render(), expected).rmse, 1e-4);
            const double bricks = brick == 33 ? 1.0 : 64.0;
            EXPECT_EQ(renderer.counters().at("osgVolumizer bricks homogeneous"), bricks);
            // A ray meets at most ten bricks of 4 x 4 x 4.
            EXPECT_LE(countSamples(twin.node, options).maximum, brick == 33 ? 1.0 : 10.0);
        }
        // One voxel that differs is enough to march.
        auto* source = static_cast<MemoryVoxelSource*>(voxels->getSource());
        static_cast<float*>(source->data())[0] = 0.6f;
        voxels->dirty();
        ASSERT_TRUE(voxels->setBrickSize({33, 33, 33}));
        EXPECT_GT(countSamples(twin.node, options).maximum, 30.0);
        static_cast<float*>(source->data())[0] = 0.5f;
        voxels->dirty();
    }
}

TEST_F(Skipping, SaturatedRaysEnd)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    for (const auto lookup :
         {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::PREINTEGRATED}) {
        osg::ref_ptr<VolumeAppearance> volume = test::makeVolume(voxels);
        volume->setLookup(lookup);
        volume->setLookupTable(makeTable(constantPoints({1.0, 0.5, 0.1, 0.9})));
        // 0.1 of the light is left after each voxel: 3e-5 after five.
        EXPECT_LE(countSamples(volume, view()).maximum, 6.0);
        volume->setLookupTable(makeTable(constantPoints({1.0, 0.5, 0.1, 0.01})));
        EXPECT_GT(countSamples(volume, view()).maximum, 60.0);
    }
}

TEST_F(Skipping, NothingIsSampledBehindOpaqueGeometry)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(makeVolume(voxels, ways()[0]));
    // A wall in front of all of it.
    const osg::ref_ptr<osg::Geometry> wall = osg::createTexturedQuadGeometry(
        osg::Vec3(-200, -20, -200), osg::Vec3(400, 0, 0), osg::Vec3(0, 0, 400));
    wall->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    const osg::Vec4 opaque(0, 0, 0, 1);
    osg::ref_ptr<osg::Vec4Array> black = new osg::Vec4Array(1, &opaque);
    wall->setColorArray(black, osg::Array::BIND_OVERALL);
    const RenderOptions options = RenderOptions().size(96, 96).perspective(40.0).lookAt(
        {32, -150, 32}, {32, 32, 32}, {0, 0, 1});
    EXPECT_GT(countSamples(scene, options).sum, 1e4);
    scene->addChild(wall);
    EXPECT_EQ(countSamples(scene, options).sum, 0.0);
}

TEST_F(Skipping, SamplesAreNoFinerThanPixels)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels, ways()[0]);
    for (const bool perspective : {true, false}) {
        RenderOptions options = view();
        const auto voxelsPerSample = [&](double distance) {
            options.lookAt(osg::Vec3d(32, 32 - distance, 32), {32, 32, 32}, {0, 0, 1});
            if (perspective)
                options.perspective(40.0);
            else
                options.orthographic(0.36397 * distance); // as high as the view is there
            support::SceneRenderer renderer(volume, options);
            renderer.render();
            return renderer.counters().at("osgVolumizer voxels per sample");
        };
        // A pixel is a voxel at a distance of 131.9 voxels.
        EXPECT_NEAR(voxelsPerSample(100.0), 1.0, 1e-9);
        EXPECT_NEAR(voxelsPerSample(1000.0), (perspective ? 968.0 : 1000.0) / 131.9, 0.02);
        EXPECT_NEAR(voxelsPerSample(4000.0), (perspective ? 3968.0 : 4000.0) / 131.9, 0.05);
    }
}

TEST_F(Skipping, VolumesUnderAPixelAreCulled)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels, ways()[0]);
    volume->setCullingActive(false); // by OSG, which may find it too small itself
    RenderOptions options = view();
    options.lookAt({32, -20000, 32}, {32, 32, 32}, {0, 0, 1});
    support::SceneRenderer renderer(volume, options);
    EXPECT_EQ(support::coveredPixels(renderer.render()).count(), 0u);
    EXPECT_EQ(voxels->getReadCount(), 0u);
    const auto counters = renderer.counters();
    ASSERT_EQ(counters.size(), 1u);
    EXPECT_EQ(counters.at("osgVolumizer volumes too small"), 1.0);
}

TEST_F(Skipping, IsosurfacesAreFoundInTheirCells)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), twoBalls);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels, ways()[0]);
    volume->setRayFunction(VolumeAppearance::ISOSURFACE);
    ASSERT_TRUE(volume->setIsoValue(0.5));
    ASSERT_TRUE(volume->setSamplingPeriod(osg::Vec3d(0.25, 0.25, 0.25)));
    const FloatImage image = support::renderScene(volume, view());
    const SampleCounts counts = countSamples(volume, view());
    std::size_t hits = 0, none = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        hits += image.pixels[i].a == 1.0f;
        none += counts.pixels[i] == 0.0f;
    }
    EXPECT_GT(hits, 100u);
    EXPECT_GT(none, image.pixels.size() / 2);
}

} // namespace SkippingTest
