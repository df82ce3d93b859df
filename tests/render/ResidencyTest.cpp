// What of a volume's bricks stays on the graphics card, and who waits for whom.

#include "Volumes.h"

#include <osgVolumizer/BrickParameters.h>
#include <osgVolumizer/Paging.h>
#include <osgVolumizer/render/context/ContextLimits.h>
#include <osgVolumizer/render/textures/BrickResidency.h>
#include <osgVolumizer/render/textures/DrawnBrick.h>

#include <support/GLTest.h>

#include <osg/RenderInfo>

#include <chrono>
#include <functional>
#include <future>
#include <vector>

namespace ResidencyTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using render::BrickResidency;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 33, BRICK = 17;
constexpr std::int64_t BRICKS = 8, BRICK_BYTES = std::int64_t(BRICK) * BRICK * BRICK * 4;

RenderOptions view()
{
    return RenderOptions().size(72, 64).perspective(45.0).lookAt({60, -36, 50}, {16, 16, 16},
                                                                 {0, 0, 1});
}

osg::ref_ptr<A> makeBricked(A::Technique technique)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    EXPECT_TRUE(voxels->setBrickSize({BRICK, BRICK, BRICK}));
    EXPECT_EQ(voxels->getLayout().brickCount(), BRICKS);
    const osg::ref_ptr<A> volume = makeVolume(voxels);
    volume->setTechnique(technique);
    volume->setLookupTable(makeTable(smoothPoints(0.2)));
    return volume;
}

osg::State& stateOf(support::SceneRenderer& renderer)
{
    return *renderer.viewer().getCamera()->getGraphicsContext()->getState();
}

// A context that draws bricks without a scene.
class Residency : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _volume = makeBricked(A::SLICES);
        _voxels = _volume->getVoxels();
        _residency = BrickResidency::of(*_voxels);
        _renderer = std::make_unique<support::SceneRenderer>(new osg::Group, view());
        _renderer->render();
        ASSERT_TRUE(_renderer->viewer().getCamera()->getGraphicsContext()->makeCurrent());
        _limits = render::queryContextLimits(stateOf(*_renderer));
    }
    void TearDown() override
    {
        if (_renderer) _renderer->viewer().getCamera()->getGraphicsContext()->releaseContext();
    }

    void ask(std::int64_t brick, unsigned frame, float priority = 0.0f)
    {
        ASSERT_TRUE(_residency->ask(*_voxels, {brick, false, frame, priority}));
    }
    void draw(std::int64_t brick, unsigned frame, float priority = 0.0f)
    {
        osg::RenderInfo renderInfo(&stateOf(*_renderer), nullptr);
        renderInfo.pushCamera(_renderer->viewer().getCamera());
        render::DrawnBrick drawn;
        drawn.texture = _residency->ask(*_voxels, {brick, false, frame, priority});
        drawn.voxels = _voxels;
        drawn.index = brick;
        EXPECT_TRUE(drawn.apply(renderInfo, _limits, 0).texture);
    }
    std::vector<std::int64_t> resident() const
    {
        std::vector<std::int64_t> bricks;
        for (std::int64_t i = 0; i < BRICKS; ++i)
            if (_residency->residency(*_voxels, i, false, context()) == render::Residency::RESIDENT)
                bricks.push_back(i);
        EXPECT_EQ(_residency->bytes(context()), BRICK_BYTES * std::int64_t(bricks.size()));
        return bricks;
    }
    unsigned context() const { return stateOf(*_renderer).getContextID(); }

    osg::ref_ptr<A> _volume;
    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<BrickResidency> _residency;
    std::unique_ptr<support::SceneRenderer> _renderer;
    render::ContextLimits _limits;
};

using Numbers = std::vector<std::int64_t>;

TEST_F(Residency, BestBricksFitTheContextAndTheBudget)
{
    osg::State& state = stateOf(*_renderer);
    PagingBudget budget = defaultPagingBudget();
    budget.textureBytes = std::int64_t(1) << 30;
    ASSERT_TRUE(setPagingBudget(budget));
    const auto ofSize = [](const glm::ivec3& size, VoxelType type) {
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        VoxelSource::Description description;
        description.size = size;
        description.type = type;
        static double none = 0.0; // nothing is read
        source->setExternal(description, &none);
        return osg::ref_ptr<Voxels>(new Voxels(source));
    };
    const auto large = bestBrickParameters(state, *ofSize({1024, 1024, 1024}, VoxelType::UINT8));
    ASSERT_TRUE(large.ok()) << large.status.text;
    EXPECT_EQ(large->brickSize, osg::Vec3i(256, 256, 256));
    EXPECT_EQ(large->internalFormat, GLenum(GL_R8)); // too large for floats anywhere
    EXPECT_EQ(large->format, GLenum(GL_RED));
    EXPECT_EQ(large->dataType, GLenum(GL_UNSIGNED_BYTE));
    EXPECT_EQ(large->brickBytes, 1 << 24);
    EXPECT_EQ(large->brickCount, 64);
    // An eighth of the budget is the bound.
    budget.textureBytes = std::int64_t(8) << 20;
    ASSERT_TRUE(setPagingBudget(budget));
    const auto small = bestBrickParameters(state, *ofSize({1024, 1024, 700}, VoxelType::UINT16));
    ASSERT_TRUE(small.ok());
    EXPECT_EQ(small->brickSize, osg::Vec3i(64, 64, 64));
    EXPECT_EQ(small->brickBytes, 1 << 19);
    EXPECT_EQ(small->brickCount, 16);
    const auto flat = bestBrickParameters(state, *ofSize({512, 512, 1}, VoxelType::UINT16));
    ASSERT_TRUE(flat.ok());
    EXPECT_TRUE(ofSize({512, 512, 1}, VoxelType::UINT16)->setBrickSize(flat->brickSize));
    // As much as llvmpipe filters best as floats is held so.
    const osg::ref_ptr<Voxels> bytes = ofSize({64, 64, 64}, VoxelType::UINT8);
    const auto floats = bestBrickParameters(state, *bytes);
    ASSERT_TRUE(floats.ok());
    EXPECT_EQ(floats->internalFormat, GLenum(_limits.filtersFloatsBest ? GL_R32F : GL_R8));
    EXPECT_EQ(floats->brickBytes, (_limits.filtersFloatsBest ? 4 : 1) << 18);
    EXPECT_EQ(bestBrickParameters(state, *osg::ref_ptr<Voxels>(new Voxels)).status.code,
              ErrorCode::VALUE_INVALID);
    setPagingBudget(defaultPagingBudget());
}

TEST_F(Residency, EverythingStaysWithoutABudget)
{
    EXPECT_EQ(_residency->budget(), BrickResidency::UNLIMITED);
    for (std::int64_t i = 0; i < BRICKS; ++i)
        draw(i, unsigned(i) + 1);
    EXPECT_EQ(resident(), (Numbers{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(_residency->lastUse(3, false), 4u);
    EXPECT_EQ(_residency->lastUse(3, true), 0u);
}

TEST_F(Residency, WhatNoFrameAskedForLongestGoesFirst)
{
    _residency->setBudget(3 * BRICK_BYTES);
    for (const std::int64_t i : {0, 1, 2})
        draw(i, 1);
    EXPECT_EQ(resident(), (Numbers{0, 1, 2}));
    ask(0, 2); // without being drawn anew
    draw(2, 2);
    draw(3, 2);
    EXPECT_EQ(resident(), (Numbers{0, 2, 3}));
    draw(1, 3);
    EXPECT_EQ(resident().size(), 3u);
    EXPECT_EQ(_residency->residency(*_voxels, 1, false, context()), render::Residency::RESIDENT);
}

TEST_F(Residency, OfOneFrameTheLeastImportantGoesFirst)
{
    _residency->setBudget(3 * BRICK_BYTES);
    draw(0, 1, 9.0f); // of an older frame, however important
    draw(1, 2, -4.0f);
    draw(2, 2, -1.0f);
    draw(3, 2, -8.0f);
    EXPECT_EQ(resident(), (Numbers{1, 2, 3}));
    draw(4, 2, -20.0f);
    EXPECT_EQ(resident(), (Numbers{1, 2, 4}));
    draw(5, 2, -2.0f);
    EXPECT_EQ(resident(), (Numbers{1, 2, 5}));
}

TEST_F(Residency, AnyBrickIsDrawnWhateverTheBudget)
{
    for (std::int64_t i = 0; i < BRICKS; ++i)
        draw(i, 1);
    _residency->setBudget(BRICK_BYTES / 2);
    for (const std::int64_t i : {5, 2}) {
        ask(i, 2);
        _voxels->dirty(i); // uploaded again
        draw(i, 2);
        EXPECT_EQ(resident(), (Numbers{i}));
    }
}

TEST_F(Residency, BudgetsHoldInEachContext)
{
    _residency->setBudget(2 * BRICK_BYTES);
    for (const std::int64_t i : {0, 1})
        draw(i, 1);
    support::SceneRenderer other(_volume, view());
    other.render();
    EXPECT_EQ(_residency->bytes(stateOf(other).getContextID()), 2 * BRICK_BYTES);
    EXPECT_EQ(resident(), (Numbers{0, 1}));
}

class Budget : public support::GLTest, public ::testing::WithParamInterface<A::Technique>
{
};

TEST_P(Budget, ChangesNoPicture)
{
    const osg::ref_ptr<A> volume = makeBricked(GetParam());
    const FloatImage expected = support::renderScene(volume, view());
    EXPECT_GT(support::coveredPixels(expected, 0.1f).count(), 300u);
    const auto residency = BrickResidency::of(*volume->getVoxels());
    residency->setBudget(3 * BRICK_BYTES); // so that they are not joined either
    RenderOptions options = view();
    options.frames = 3;
    support::SceneRenderer renderer(volume, options);
    EXPECT_LE(compare(renderer.render(), expected).maximum, GetParam() == A::SLICES ? 1e-6 : 1e-3);
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_EQ(residency->bytes(stateOf(renderer).getContextID()), 3 * BRICK_BYTES);
}

INSTANTIATE_TEST_SUITE_P(Techniques, Budget, ::testing::Values(A::SLABS, A::SLICES), techniqueName);

// Every read does something else meanwhile, in another thread, and waits for that.
class SlowSource : public MemoryVoxelSource
{
public:
    Status read(const core::Box3i& region, void* destination) const override
    {
        if (meanwhile) {
            pending.push_back(std::async(std::launch::async, meanwhile));
            finished = finished && pending.back().wait_for(std::chrono::seconds(5)) ==
                                       std::future_status::ready;
            ++reads;
        }
        return MemoryVoxelSource::read(region, destination);
    }
    VoxelBlock share(const core::Box3i&) const override { return {}; }

    std::function<void()> meanwhile;
    mutable std::vector<std::future<void>> pending;
    mutable bool finished = true;
    mutable int reads = 0;
};

class SlowReads : public support::GLTest, public ::testing::WithParamInterface<A::Technique>
{
};

TEST_P(SlowReads, MakeNobodyWait)
{
    const osg::ref_ptr<A> like = makeBricked(GetParam());
    const osg::ref_ptr<MemoryVoxelSource> memory =
        static_cast<MemoryVoxelSource*>(like->getVoxels()->getSource());
    osg::ref_ptr<SlowSource> source = new SlowSource;
    ASSERT_TRUE(source->setExternal(memory->describe(), memory->data()));
    const osg::ref_ptr<Voxels> voxels = new Voxels(source);
    voxels->setRange(osg::Vec2d(0.0, 1.0));
    ASSERT_TRUE(voxels->setBrickSize({BRICK, BRICK, BRICK}));
    like->setVoxels(voxels);
    const auto residency = BrickResidency::of(*voxels);
    // In whatever context, of all bricks, among them the one that is being read.
    source->meanwhile = [&]() {
        for (unsigned context = 0; context < 8; ++context) {
            residency->bytes(context);
            for (std::int64_t i = 0; i < BRICKS; ++i)
                residency->residency(*voxels, i, false, context);
        }
        for (std::int64_t i = 0; i < BRICKS; ++i) {
            residency->lastUse(i, false);
            voxels->getModifiedCount(i);
        }
    };
    support::SceneRenderer renderer(like, view()); // reads while it culls
    const FloatImage first = renderer.render();
    EXPECT_GE(source->reads, BRICKS);
    for (std::int64_t i = 0; i < BRICKS; ++i)
        voxels->releaseBrick(i);
    source->reads = 0;
    support::SceneRenderer second(like, view()); // and while it draws
    EXPECT_LE(compare(second.render(), first).maximum, 1e-6);
    EXPECT_LT(stateOf(second).getContextID(), 8u);
    EXPECT_GE(source->reads, BRICKS);
    EXPECT_TRUE(source->finished);
    source->pending.clear(); // waits for what refers to the others
}

INSTANTIATE_TEST_SUITE_P(Techniques, SlowReads, ::testing::Values(A::SLABS, A::SLICES),
                         techniqueName);

} // namespace

} // namespace ResidencyTest
