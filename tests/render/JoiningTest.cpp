// Many bricks in one texture: drawn at once, read and uploaded one by one.

#include "Volumes.h"

#include <osgVolumizer/render/context/ContextLimits.h>

#include <support/GLTest.h>

#include <algorithm>
#include <atomic>

namespace JoiningTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 33, BRICK = 9; // 64 bricks

RenderOptions view()
{
    return RenderOptions().size(72, 64).perspective(45.0).lookAt({60, -36, 50}, {16, 16, 16},
                                                                 {0, 0, 1});
}

// Samples of a function, of which it knows the ranges without a look at them; notes what is read.
class KnowingSource : public MemoryVoxelSource
{
public:
    explicit KnowingSource(const std::function<double(const glm::dvec3&)>& value)
    {
        Description d;
        d.size = glm::ivec3(SIZE);
        d.type = VoxelType::FLOAT32;
        allocate(d);
        float* out = static_cast<float*>(data());
        for (int z = 0; z < SIZE; ++z)
            for (int y = 0; y < SIZE; ++y)
                for (int x = 0; x < SIZE; ++x)
                    *out++ = static_cast<float>(value(glm::dvec3(x, y, z)));
    }
    Status read(const core::Box3i& region, void* destination) const override
    {
        ++reads;
        return MemoryVoxelSource::read(region, destination);
    }
    VoxelBlock share(const core::Box3i&) const override { return {}; }
    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override
    {
        const float* values = static_cast<const float*>(data());
        std::pair<double, double> range(1e30, -1e30);
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x) {
                    const double v = values[x + SIZE * (y + SIZE * z)];
                    range = {std::min(range.first, v), std::max(range.second, v)};
                }
        return range;
    }
    mutable std::atomic<int> reads{0};
};

double counter(const support::SceneRenderer& renderer, const std::string& name)
{
    const auto counters = renderer.counters();
    const auto found = counters.find("osgVolumizer " + name);
    return found == counters.end() ? 0.0 : found->second;
}

FloatImage separately(osg::Node* scene, const RenderOptions& options)
{
    return support::renderScene(scene, support::joining(options, false));
}

// Full on one side of a slanted plane, and something else beyond it that a band-pass hides too.
double halves(const glm::dvec3& p)
{
    const double d = (0.6 * p.x - 0.7 * (p.y - 32.0) + 0.4 * p.z - 27.0) / 12.0;
    return std::clamp(0.5 + 0.5 * d, 0.0, 1.0) * (0.8 + 0.2 * bumps(p));
}

// Shows the middle of the range only: values that a filter makes between both ends would show.
const Points BAND = {{0.0, {0, 0, 1, 0.0}},     {0.2, {0, 0, 1, 0.0}},   {0.4, {0.2, 0.8, 1, 0.3}},
                     {0.6, {1, 0.5, 0.2, 0.3}}, {0.7, {1, 0.5, 0, 0.0}}, {1.0, {1, 0, 0, 0.0}}};

class Joining : public support::GLTest
{
protected:
    // In bricks that their own texture and one for all of them suit alike.
    osg::ref_ptr<VolumeAppearance> makeBricks(const std::function<double(const glm::dvec3&)>& value,
                                              const Points& points, int overlap = 1)
    {
        _source = new KnowingSource(value);
        osg::ref_ptr<Voxels> voxels = new Voxels(_source);
        EXPECT_TRUE(voxels->setRange(osg::Vec2d(0.0, 1.0)));
        EXPECT_TRUE(voxels->setOverlap(overlap));
        EXPECT_TRUE(voxels->setBrickSize({BRICK, BRICK, BRICK}));
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
        volume->setTechnique(A::SLABS);
        volume->setLookupTable(makeTable(points));
        volume->setSamplingPeriod(osg::Vec3d(0.5, 0.5, 0.5));
        return volume;
    }
    osg::ref_ptr<KnowingSource> _source;
};

TEST_F(Joining, SixtyFourBricksAreOneDrawCall)
{
    osg::ref_ptr<VolumeAppearance> volume = makeBricks(bumps, smoothPoints(0.2));
    support::SceneRenderer renderer(volume, view());
    const FloatImage image = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_EQ(counter(renderer, "draw calls"), 1);
    EXPECT_EQ(counter(renderer, "bricks drawn"), 64);
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 64);
    renderer.render();
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 0);
    EXPECT_EQ(counter(renderer, "bytes uploaded"), 0);
    // A close view of one brick finds it there.
    renderer.options().perspective(2.0).lookAt({60, -36, 50}, {29, 3, 29}, {0, 0, 1});
    renderer.render();
    EXPECT_LT(counter(renderer, "bricks drawn"), 32);
    EXPECT_EQ(counter(renderer, "draw calls"), 1);
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 0);
    renderer.options() = view();
    EXPECT_LE(compare(image, separately(volume, view())).maximum, 1e-4);
    support::viewHooks(renderer.viewer()).joining = false;
    renderer.render();
    EXPECT_EQ(counter(renderer, "draw calls"), 64);
}

TEST_F(Joining, ShowsTheSameInEveryWay)
{
    struct Way
    {
        A::Interpolation interpolation;
        A::Lookup lookup;
        A::RayFunction function;
        bool shading;
        A::Gradients gradients;
    };
    const Way ways[] = {{A::LINEAR, A::AFTER_INTERPOLATION, A::COMPOSITE, false, A::ON_THE_FLY},
                        {A::LINEAR, A::PREINTEGRATED, A::COMPOSITE, false, A::ON_THE_FLY},
                        {A::LINEAR, A::BEFORE_INTERPOLATION, A::COMPOSITE, false, A::ON_THE_FLY},
                        {A::NEAREST, A::AFTER_INTERPOLATION, A::COMPOSITE, false, A::ON_THE_FLY},
                        {A::CUBIC, A::AFTER_INTERPOLATION, A::COMPOSITE, false, A::ON_THE_FLY},
                        {A::LINEAR, A::AFTER_INTERPOLATION, A::COMPOSITE, true, A::ON_THE_FLY},
                        {A::LINEAR, A::AFTER_INTERPOLATION, A::COMPOSITE, true, A::PRECOMPUTED},
                        {A::LINEAR, A::AFTER_INTERPOLATION, A::MAXIMUM, false, A::ON_THE_FLY},
                        {A::LINEAR, A::AFTER_INTERPOLATION, A::AVERAGE, false, A::ON_THE_FLY},
                        {A::LINEAR, A::AFTER_INTERPOLATION, A::ISOSURFACE, true, A::ON_THE_FLY}};
    for (const Way& way : ways) {
        const bool surface = way.function == A::ISOSURFACE;
        osg::ref_ptr<VolumeAppearance> volume = makeBricks(surface ? bumps : halves, BAND, 5);
        ASSERT_TRUE(volume->getVoxels()->setBrickSize({13, 13, 13}));
        volume->setInterpolation(way.interpolation);
        volume->setLookup(way.lookup);
        volume->setRayFunction(way.function);
        volume->setShading(way.shading);
        volume->setGradients(way.gradients);
        volume->setIsoValue(0.45);
        support::SceneRenderer renderer(volume, view());
        const FloatImage image = renderer.render();
        const std::string name = "joined_" + std::to_string(&way - ways);
        support::savePicture(image, name);
        EXPECT_GT(support::coveredPixels(image, 0.2f).count(), 200u) << name;
        EXPECT_GT(counter(renderer, "bricks drawn"), 8) << name;
        EXPECT_EQ(counter(renderer, "draw calls"), 1) << name;
        ASSERT_TRUE(volume->getVoxels()->setBrickSize({SIZE, SIZE, SIZE}));
        const support::Difference d = compare(image, support::renderScene(volume, view()));
        EXPECT_LE(d.maximum, 1e-5) << name << " at " << d.worstX << " " << d.worstY;
    }
}

TEST_F(Joining, GradientsReachIntoTheNextBrick)
{
    // An overlap of one sample, which is too little for gradients of bricks by themselves.
    osg::ref_ptr<VolumeAppearance> volume = makeBricks(bumps, smoothPoints(0.5), 1);
    volume->setShading(true);
    ASSERT_TRUE(volume->getVoxels()->setOverlap(1));
    const FloatImage image = support::renderScene(volume, view());
    EXPECT_GT(support::coveredPixels(image, 0.2f).count(), 1000u);
    ASSERT_TRUE(volume->getVoxels()->setBrickSize({SIZE, SIZE, SIZE}));
    EXPECT_LE(compare(image, support::renderScene(volume, view())).maximum, 1e-5);
}

TEST_F(Joining, EmptyBricksAreNotReadAndStayEmpty)
{
    osg::ref_ptr<VolumeAppearance> volume = makeBricks(halves, BAND);
    support::SceneRenderer renderer(volume, view());
    const FloatImage image = renderer.render();
    EXPECT_EQ(counter(renderer, "draw calls"), 1);
    const double drawn = counter(renderer, "bricks drawn");
    EXPECT_GT(drawn, 8);
    EXPECT_LT(drawn, 56);
    EXPECT_EQ(counter(renderer, "bricks uploaded"), drawn);
    EXPECT_EQ(_source->reads, drawn);
    EXPECT_EQ(counter(renderer, "bricks empty"), 64 - drawn);

    // A table that shows all: what was empty is read now, and the rest not again.
    const osg::ref_ptr<LookupTable> band = volume->getLookupTable();
    volume->setLookupTable(makeTable({{0.0, {1, 1, 1, 0.01}}, {1.0, {1, 0.5, 0, 0.1}}}));
    const FloatImage all = renderer.render();
    EXPECT_EQ(counter(renderer, "bricks drawn"), 64);
    EXPECT_EQ(counter(renderer, "draw calls"), 1);
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 64 - drawn);
    EXPECT_EQ(_source->reads, 64);

    // And back.
    volume->setLookupTable(band);
    EXPECT_LE(compare(renderer.render(), image).maximum, 1e-6);
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 0);
    EXPECT_LE(compare(image, separately(volume, view())).maximum, 1e-4);
    volume->setLookupTable(makeTable({{0.0, {1, 1, 1, 0.01}}, {1.0, {1, 0.5, 0, 0.1}}}));
    EXPECT_LE(compare(all, separately(volume, view())).maximum, 1e-4);
}

TEST_F(Joining, EmptyBricksMayComeLater)
{
    // Two full slices of bricks, and two empty ones that share a plane of varying samples with
    // them, but are out of view at first.
    const auto value = [](const glm::dvec3& p) {
        return p.x < 15.5 ? 0.4 + 0.1 * bumps(p) : 0.72 + 0.25 * bumps(glm::dvec3(0.0, p.y, p.z));
    };
    osg::ref_ptr<VolumeAppearance> volume = makeBricks(value, BAND);
    ASSERT_TRUE(volume->getVoxels()->setBrickSize({BRICK, SIZE, SIZE}));
    support::SceneRenderer renderer(volume, view());
    renderer.options().orthographic(5.0).lookAt({8, -60, 16}, {8, 16, 16}, {0, 0, 1});
    renderer.render();
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 2);
    EXPECT_EQ(counter(renderer, "bricks empty"), 0);
    renderer.options() = view();
    const FloatImage image = renderer.render();
    EXPECT_EQ(counter(renderer, "draw calls"), 1);
    EXPECT_EQ(counter(renderer, "bricks empty"), 2);
    // The one next to the empty ones is uploaded again, since they share samples.
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 1);
    EXPECT_EQ(_source->reads, 2);
    const support::Difference d = compare(image, separately(volume, view()));
    EXPECT_LE(d.maximum, 1e-4) << "at " << d.worstX << " " << d.worstY;
}

TEST_F(Joining, ContextsHaveTexturesOfTheirOwn)
{
    osg::ref_ptr<VolumeAppearance> volume = makeBricks(halves, BAND);
    support::SceneRenderer first(volume, view());
    const FloatImage image = first.render();
    support::SceneRenderer second(volume, view());
    EXPECT_EQ(compare(second.render(), image).maximum, 0.0);
    EXPECT_GT(counter(second, "bricks uploaded"), 0);
    // What a context had is gone, and comes back.
    volume->releaseGLObjects();
    EXPECT_EQ(compare(first.render(), image).maximum, 0.0);
    EXPECT_GT(counter(first, "bricks uploaded"), 0);
    EXPECT_EQ(first.glError(), 0u);
}

TEST_F(Joining, WhatIsBetterApartStaysApart)
{
    // Two balls in far corners: most bricks between them show nothing.
    const auto balls = [](const glm::dvec3& p) {
        const double a = glm::length(p - glm::dvec3(5)), b = glm::length(p - glm::dvec3(27));
        return std::max(0.0, 1.0 - std::min(a, b) / 5.0);
    };
    // One value, but for a brick in the middle.
    const auto fog = [](const glm::dvec3& p) {
        return glm::length(p - glm::dvec3(12.0)) < 3.0 ? 0.9 : 0.4;
    };
    for (const auto& value : {std::function<double(const glm::dvec3&)>(balls),
                              std::function<double(const glm::dvec3&)>(fog)}) {
        osg::ref_ptr<VolumeAppearance> volume = makeBricks(value, smoothPoints(0.2));
        support::SceneRenderer renderer(volume, view());
        renderer.render();
        EXPECT_GT(counter(renderer, "bricks drawn"), 1);
        EXPECT_EQ(counter(renderer, "draw calls"), counter(renderer, "bricks drawn"));
    }
}

TEST_F(Joining, TooLargeForATextureStaysApart)
{
    osg::ref_ptr<VolumeAppearance> volume = makeBricks(bumps, smoothPoints(0.2));
    const FloatImage expected = support::renderScene(volume, view());
    support::SceneRenderer renderer(
        volume,
        support::limited(view(), [](render::ContextLimits& limits) { limits.texture3DSize = 32; }));
    EXPECT_LE(compare(renderer.render(), expected).maximum, 1e-4);
    EXPECT_EQ(counter(renderer, "draw calls"), 64);
}

TEST_F(Joining, AnUnreadableBrickIsAHole)
{
    class Failing : public KnowingSource
    {
    public:
        Failing() : KnowingSource(bumps) {}
        Status read(const core::Box3i& region, void* destination) const override
        {
            if (region.min == glm::ivec3(16, 8, 16))
                return {ErrorCode::FILE_UNREADABLE, "a brick cannot be read"};
            return KnowingSource::read(region, destination);
        }
    };
    osg::ref_ptr<VolumeAppearance> volume = makeBricks(bumps, smoothPoints(0.2));
    osg::ref_ptr<Failing> source = new Failing;
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    ASSERT_TRUE(voxels->setRange(osg::Vec2d(0.0, 1.0)));
    ASSERT_TRUE(voxels->setBrickSize({BRICK, BRICK, BRICK}));
    volume->setVoxels(voxels);
    support::SceneRenderer renderer(volume, view());
    EXPECT_GT(support::coveredPixels(renderer.render(), 0.1f).count(), 500u);
    EXPECT_EQ(counter(renderer, "bricks drawn"), 63);
    EXPECT_EQ(counter(renderer, "draw calls"), 63);
}

} // namespace

} // namespace JoiningTest
