// What the graphics card refuses, and how much is asked of it.

#include "Volumes.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/render/context/Allocation.h>
#include <osgVolumizer/render/context/ContextLimits.h>
#include <osgVolumizer/render/textures/BrickResidency.h>

#include <support/GLTest.h>
#include <support/Reports.h>

#include <osg/Texture3D>

#include <atomic>
#include <vector>

namespace CardMemoryTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using render::AllocationRequest;
using support::FloatImage;
using support::RenderOptions;
using support::Reports;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 33;

RenderOptions view()
{
    return RenderOptions().size(72, 64).perspective(45.0).lookAt({60, -36, 50}, {16, 16, 16},
                                                                 {0, 0, 1});
}

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

class CardMemory : public support::GLTest
{
protected:
    static RenderOptions refusing(const RenderOptions& options, AllocationRequest::Kind kind,
                                  int largestSide = 0)
    {
        return support::refusing(options, [kind, largestSide](const AllocationRequest& request) {
            return request.kind == kind &&
                   std::max({request.size.x, request.size.y, request.size.z}) > largestSide;
        });
    }
    static void refuseNothing(support::SceneRenderer& renderer)
    {
        support::contextHooks(renderer.viewer()).refuses = nullptr;
    }
    // A size of bricks for each test, since a message is reported once in a process.
    static osg::ref_ptr<A> makeBricks(const glm::ivec3& size, int brick, int overlap = 1)
    {
        osg::ref_ptr<Voxels> voxels = makeVoxels(size, bumps);
        EXPECT_TRUE(voxels->setOverlap(overlap));
        EXPECT_TRUE(voxels->setBrickSize({brick, brick, brick}));
        osg::ref_ptr<A> volume = makeVolume(voxels);
        volume->setTechnique(A::SLABS);
        volume->setLookupTable(makeTable(smoothPoints(0.2)));
        volume->setSamplingPeriod(osg::Vec3d(0.5, 0.5, 0.5));
        return volume;
    }
};

TEST_F(CardMemory, WhatGLRefusesLeavesNoErrorAndNoTexture)
{
    class Asks : public osg::Drawable
    {
    public:
        Asks()
        {
            setUseDisplayList(false);
            setSupportsDisplayList(false);
        }
        osg::Object* cloneType() const override { return new Asks; }
        osg::Object* clone(const osg::CopyOp&) const override { return new Asks; }
        const char* libraryName() const override { return "test"; }
        const char* className() const override { return "Asks"; }
        osg::BoundingBox computeBoundingBox() const override { return {-1, -1, -1, 1, 1, 1}; }
        void drawImplementation(osg::RenderInfo& info) const override
        {
            osg::State& state = *info.getState();
            const auto textureOf = [](int width) {
                osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D;
                texture->setTextureSize(width, 1, 1);
                texture->setInternalFormat(GL_R32F);
                texture->setSourceFormat(GL_RED);
                texture->setSourceType(GL_FLOAT);
                texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
                return texture;
            };
            const int largest = render::queryContextLimits(state).texture3DSize;
            for (int i = 0; i < 2; ++i) { // OSG uses what it has given up again
                const osg::ref_ptr<osg::Texture3D> large = textureOf(largest + 1);
                largeMade = render::applyAllocated(state, AllocationRequest::BRICK, *large, 1);
                largeKept = large->getTextureObject(state.getContextID()) != nullptr;
            }
            error = glGetError();
            const osg::ref_ptr<osg::Texture3D> small = textureOf(16);
            smallMade = render::applyAllocated(state, AllocationRequest::BRICK, *small, 1) &&
                        small->getTextureObject(state.getContextID());
        }
        mutable bool largeMade = true, largeKept = true, smallMade = false;
        mutable GLenum error = GL_INVALID_ENUM;
    };
    const osg::ref_ptr<Asks> asks = new Asks;
    support::SceneRenderer renderer(asks, view().lookAt({0, -9, 0}, {0, 0, 0}, {0, 0, 1}));
    renderer.render();
    EXPECT_FALSE(asks->largeMade);
    EXPECT_FALSE(asks->largeKept);
    EXPECT_TRUE(asks->smallMade);
    EXPECT_EQ(asks->error, GLenum(GL_NO_ERROR));
    EXPECT_EQ(renderer.glError(), 0u);
}

TEST_F(CardMemory, BricksThatCannotShareATextureHaveTheirOwn)
{
    struct Way
    {
        A::Interpolation interpolation;
        A::Lookup lookup;
        bool shading;
        A::Gradients gradients;
    };
    const Way ways[] = {{A::LINEAR, A::AFTER_INTERPOLATION, false, A::ON_THE_FLY},
                        {A::LINEAR, A::PREINTEGRATED, false, A::ON_THE_FLY},
                        {A::CUBIC, A::AFTER_INTERPOLATION, false, A::ON_THE_FLY},
                        {A::LINEAR, A::AFTER_INTERPOLATION, true, A::PRECOMPUTED}};
    for (const Way& way : ways) {
        const int number = static_cast<int>(&way - ways);
        osg::ref_ptr<A> volume = makeBricks({SIZE + number, SIZE, SIZE}, 13, 5);
        volume->setInterpolation(way.interpolation);
        volume->setLookup(way.lookup);
        volume->setShading(way.shading);
        volume->setGradients(way.gradients);
        const FloatImage expected = separately(volume, view());
        volume->releaseGLObjects();
        Reports reports;
        support::SceneRenderer renderer(volume, refusing(view(), AllocationRequest::JOINED_BRICKS));
        // The first frame finds out while it draws, the second one knows.
        for (int frame = 0; frame < 2; ++frame) {
            const support::Difference d = compare(renderer.render(), expected);
            EXPECT_LE(d.maximum, 1e-4)
                << number << " frame " << frame << " at " << d.worstX << " " << d.worstY;
        }
        EXPECT_GT(counter(renderer, "draw calls"), 8) << number;
        EXPECT_EQ(counter(renderer, "bricks uploaded"), 0) << number;
        EXPECT_EQ(renderer.glError(), 0u);
        EXPECT_EQ(reports.count(std::to_string(SIZE + number) + ",33,33"), 1);
        EXPECT_EQ(reports.all(), 1u);
    }
}

TEST_F(CardMemory, JoinedBricksKeepTheirOrderInEveryView)
{
    osg::ref_ptr<A> volume = makeBricks({SIZE, SIZE, SIZE}, 9);
    volume->setLookupTable(makeTable(smoothPoints(0.6)));
    const osg::Vec3d eyes[] = {{60, -36, 50}, {-40, 50, -20}, {16, 70, 16}, {16.5, 15, 17}};
    for (const osg::Vec3d& eye : eyes)
        for (const bool parallel : {false, true}) {
            RenderOptions options = view().lookAt(eye, {16, 17, 15}, {0.1, 0, 1});
            if (parallel) options.orthographic(25.0);
            volume->releaseGLObjects();
            const FloatImage expected = separately(volume, options);
            volume->releaseGLObjects();
            const FloatImage image =
                support::renderScene(volume, refusing(options, AllocationRequest::JOINED_BRICKS));
            const support::Difference d = compare(image, expected);
            EXPECT_LE(d.maximum, 1e-5) << eye.x() << " at " << d.worstX << " " << d.worstY;
        }
}

TEST_F(CardMemory, ABrickThatIsTooLargeIsDrawnCoarser)
{
    const auto linear = [](const glm::dvec3& p) { return 0.02 * p.x + 0.015 * p.y + 0.01 * p.z; };
    osg::ref_ptr<A> volume = makeVolume(makeVoxels({27, 21, 17}, linear));
    volume->setTechnique(A::SLABS);
    volume->setLookupTable(makeTable(smoothPoints(0.1)));
    const FloatImage expected = support::renderScene(volume, view());
    volume->releaseGLObjects();
    Reports reports;
    support::SceneRenderer renderer(volume, refusing(view(), AllocationRequest::BRICK, 8));
    // What varies linearly loses nothing.
    EXPECT_LE(compare(renderer.render(), expected).maximum, 1e-3);
    renderer.render();
    EXPECT_EQ(counter(renderer, "bricks uploaded"), 0);
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_EQ(reports.count("27,21,17"), 1);
    EXPECT_EQ(reports.all(), 1u);
}

TEST_F(CardMemory, ABrickThatIsRefusedAltogetherIsAHole)
{
    osg::ref_ptr<A> volume = makeBricks({29, SIZE, SIZE}, 64);
    Reports reports;
    support::SceneRenderer renderer(volume, refusing(view(), AllocationRequest::BRICK));
    for (int frame = 0; frame < 2; ++frame)
        EXPECT_EQ(support::coveredPixels(renderer.render()).count(), 0u);
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_EQ(reports.count("not drawn"), 1);
    EXPECT_EQ(reports.all(), 1u);
    // Once there is room again it is there.
    refuseNothing(renderer);
    volume->releaseGLObjects();
    EXPECT_GT(support::coveredPixels(renderer.render(), 0.1f).count(), 500u);
}

TEST_F(CardMemory, WithoutCellsNothingIsLeaptOver)
{
    const auto ball = [](const glm::dvec3& p) {
        return std::max(0.0, 1.0 - glm::length(p - glm::dvec3(16)) / 9.0);
    };
    osg::ref_ptr<A> volume = makeVolume(makeVoxels(glm::ivec3(129), ball));
    volume->setTechnique(A::SLABS);
    volume->setLookupTable(
        makeTable({{0.0, {0, 0, 1, 0.0}}, {0.1, {0, 0, 1, 0.0}}, {1.0, {1, 0.5, 0.1, 0.3}}}));
    const FloatImage expected = support::renderScene(volume, view());
    volume->releaseGLObjects();
    int asked = 0;
    const auto isRefused = [&asked](const AllocationRequest& request) {
        asked += request.kind == AllocationRequest::CELLS;
        return request.kind == AllocationRequest::CELLS;
    };
    Reports reports;
    support::SceneRenderer renderer(volume, support::refusing(view(), isRefused));
    EXPECT_LE(compare(renderer.render(), expected).maximum, 1e-5);
    EXPECT_GT(asked, 0);
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_EQ(reports.all(), 1u);
}

TEST_F(CardMemory, WithoutItsTableAVolumeIsNotDrawn)
{
    osg::ref_ptr<A> volume = makeBricks({SIZE, SIZE, SIZE}, 64);
    for (const bool gathers : {false, true}) {
        volume->setRayFunction(gathers ? A::MAXIMUM : A::COMPOSITE);
        volume->releaseGLObjects();
        Reports reports;
        support::SceneRenderer renderer(volume, refusing(view(), AllocationRequest::TABLE));
        EXPECT_EQ(support::coveredPixels(renderer.render()).count(), 0u);
        EXPECT_EQ(renderer.glError(), 0u);
        EXPECT_LE(reports.all(), 1u);
        refuseNothing(renderer);
        EXPECT_GT(support::coveredPixels(renderer.render(), 0.1f).count(), 500u);
    }
}

TEST_F(CardMemory, PaintThatIsRefusedPaintsNothing)
{
    osg::ref_ptr<A> paint = makeBricks({23, 21, 19}, 32);
    paint->setCombineRule(A::PAINT);
    osg::ref_ptr<A> painted = makeBricks({12, 12, 12}, 32);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(painted);
    const FloatImage plain = support::renderScene(scene, view());
    scene->addChild(paint);
    EXPECT_GT(compare(support::renderScene(scene, view()), plain).maximum, 0.02);
    paint->releaseGLObjects();
    support::SceneRenderer renderer(
        scene, support::refusing(view(), [](const AllocationRequest& request) {
            return request.kind == AllocationRequest::BRICK && request.size.x != 12;
        }));
    EXPECT_LE(compare(renderer.render(), plain).maximum, 1e-4);
    EXPECT_EQ(renderer.glError(), 0u);
}

// 8-bit voxels from a formula: no block is shared, and what is read is counted.
class BytesSource : public VoxelSource
{
public:
    META_Object(test, BytesSource) BytesSource() = default;
    explicit BytesSource(int size) : _size(size) {}
    BytesSource(const BytesSource& o, const osg::CopyOp& op) : VoxelSource(o, op), _size(o._size) {}
    Description describe() const override
    {
        Description d;
        d.size = glm::ivec3(_size);
        d.spacing = glm::dvec3(32.0 / _size);
        return d;
    }
    Status read(const core::Box3i& region, void* destination) const override
    {
        reads += 1;
        auto* out = static_cast<unsigned char*>(destination);
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    *out++ =
                        static_cast<unsigned char>(40.5 + 200.0 * (x + 2 * y + z) / (4.0 * _size));
        return {};
    }
    mutable std::atomic<int> reads{0};

private:
    int _size = 1;
};

// Large enough to be stored as it is in every context.
constexpr int LARGE = 258;

osg::ref_ptr<A> makeLarge(int brick, osg::ref_ptr<BytesSource>& source)
{
    source = new BytesSource(LARGE);
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    EXPECT_TRUE(voxels->setBrickSize({brick, brick, brick}));
    osg::ref_ptr<A> volume = makeVolume(voxels);
    volume->setTechnique(A::SLABS);
    volume->setLookupTable(makeTable(smoothPoints(0.2)));
    volume->setSamplingPeriod(osg::Vec3d(4, 4, 4));
    return volume;
}

TEST_F(CardMemory, LargeVolumesTakeNoMoreThanTheirFile)
{
    const double file = double(LARGE) * LARGE * LARGE;
    for (const bool joined : {true, false}) {
        osg::ref_ptr<BytesSource> source;
        osg::ref_ptr<A> volume = makeLarge(130, source);
        double asked = 0.0;
        const auto count = [&asked](const AllocationRequest& request) {
            const bool bytes = request.internalFormat == GL_R8;
            if (request.kind == AllocationRequest::BRICK ||
                request.kind == AllocationRequest::JOINED_BRICKS)
                asked +=
                    double(request.size.x) * request.size.y * request.size.z * (bytes ? 1.0 : 4.0);
            return false;
        };
        const RenderOptions options = support::joining(view(), joined);
        support::SceneRenderer renderer(volume, support::refusing(options, count));
        EXPECT_GT(support::coveredPixels(renderer.render(), 0.1f).count(), 500u);
        EXPECT_GE(asked, file);
        EXPECT_LE(asked, 1.05 * file); // shared samples
        const unsigned context =
            renderer.viewer().getCamera()->getGraphicsContext()->getState()->getContextID();
        const auto residency = render::BrickResidency::of(*volume->getVoxels());
        EXPECT_EQ(double(residency->bytes(context)), asked);
        EXPECT_EQ(residency->residency(*volume->getVoxels(), 0, false, context),
                  render::Residency::RESIDENT);
        EXPECT_EQ(residency->residency(*volume->getVoxels(), 0, false, context + 1),
                  render::Residency::NOT_YET);
        EXPECT_LE(volume->getVoxels()->getCachedBytes(), Voxels::CACHE_BYTES);
        // Where the samples are forgotten, only what lacks them asks for them again.
        const std::int64_t bricks = volume->getVoxels()->getLayout().brickCount();
        for (std::int64_t i = 0; i < bricks; ++i)
            volume->getVoxels()->releaseBrick(i);
        const int reads = source->reads;
        volume->getLookupTable()->setPoints(smoothPoints(0.3), LookupTable::RANGE_FRACTION);
        const FloatImage image = renderer.render();
        EXPECT_EQ(source->reads, reads);
        EXPECT_EQ(counter(renderer, "bytes uploaded"), 0);
        support::SceneRenderer second(volume, options);
        EXPECT_LE(compare(second.render(), image).maximum, 1e-6);
        EXPECT_EQ(source->reads, reads + bricks);
    }
}

TEST_F(CardMemory, LargeVolumesAreFilteredAsExactlyAsSmallOnes)
{
    osg::ref_ptr<BytesSource> source;
    osg::ref_ptr<A> volume = makeLarge(LARGE, source);
    // Few values, magnified: steps of a 255th would show.
    volume->setLookupTable(makeTable({{0.5, {0, 0, 0, 0.0}}, {0.52, {1, 1, 1, 0.4}}}));
    volume->setSamplingPeriod(osg::Vec3d(0.5, 0.5, 0.5));
    const FloatImage image = support::renderScene(volume, view());
    volume->releaseGLObjects();
    // Fetched samples, which the shader filters, are the truth.
    volume->setExactFiltering(true);
    const FloatImage expected = support::renderScene(volume, view());
    EXPECT_GT(support::coveredPixels(expected, 0.2f).count(), 300u);
    EXPECT_LE(compare(image, expected).rmse, 1e-3);
}

TEST_F(CardMemory, ASourceThatFailsIsNever)
{
    class Failing : public BytesSource
    {
    public:
        Failing() : BytesSource(20) {}
        Status read(const core::Box3i&, void*) const override
        {
            return {ErrorCode::FILE_UNREADABLE, "nothing can be read here"};
        }
    };
    Reports reports;
    osg::ref_ptr<A> volume = makeVolume(new Voxels(new Failing));
    support::SceneRenderer renderer(volume, view());
    EXPECT_EQ(support::coveredPixels(renderer.render()).count(), 0u);
    const auto residency = render::BrickResidency::of(*volume->getVoxels());
    EXPECT_FALSE(residency->ask(*volume->getVoxels(), {0, false, 1}));
    EXPECT_EQ(residency->residency(*volume->getVoxels(), 0, false, 0), render::Residency::NEVER);
    EXPECT_EQ(reports.all(), 1u);
}

} // namespace

} // namespace CardMemoryTest
