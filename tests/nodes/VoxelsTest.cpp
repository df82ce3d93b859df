#include <osgVolumizer/Error.h>
#include <osgVolumizer/Voxels.h>
#include <osgVolumizer/render/context/RenderDataAccess.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <thread>

namespace VoxelsTest {

using namespace osgVolumizer;

namespace {

VoxelSource::Description description(const glm::ivec3& size, VoxelType type = VoxelType::UINT16)
{
    VoxelSource::Description d;
    d.size = size;
    d.type = type;
    return d;
}

/// x + 100 y + 10000 z as UINT16, computed; counts its reads.
class FormulaSource : public VoxelSource
{
public:
    META_Object(test, FormulaSource) FormulaSource() = default;
    explicit FormulaSource(const glm::ivec3& size) : _size(size) {}
    FormulaSource(const FormulaSource& o, const osg::CopyOp& op) : VoxelSource(o, op) {}

    Description describe() const override { return description(_size); }
    Status read(const core::Box3i& region, void* destination) const override
    {
        ++reads;
        if (throws) throw std::runtime_error("disk on fire");
        if (fails) return {ErrorCode::FILE_UNREADABLE, "no luck"};
        auto* to = static_cast<std::uint16_t*>(destination);
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    *to++ = static_cast<std::uint16_t>(x + 100 * y + 10000 * z);
        return {};
    }
    mutable std::atomic<int> reads{0};
    bool fails = false, throws = false;

private:
    ~FormulaSource() override = default;
    glm::ivec3 _size{0};
};

std::uint16_t at(const Voxels::Block& block, std::size_t i)
{
    std::uint16_t v = 0;
    std::memcpy(&v, block.data + 2 * i, 2);
    return v;
}

osg::ref_ptr<MemoryVoxelSource> memorySource(const glm::ivec3& size,
                                             VoxelType type = VoxelType::UINT16)
{
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(description(size, type)).ok());
    return source;
}

} // namespace

TEST(Voxels, BricksHoldTheirSamples)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource({9, 6, 3});
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    ASSERT_TRUE(voxels->setBrickSize({5, 4, 3}).ok());
    ASSERT_EQ(4, voxels->getLayout().brickCount());
    const Voxels::Block block = voxels->getBrick(3); // samples x 4..8, y 3..5, z 0..2
    ASSERT_EQ(2u * 5 * 3 * 3, block.bytes);
    EXPECT_EQ(304, at(block, 0));
    EXPECT_EQ(20508, at(block, 44));
    EXPECT_EQ(304.0, voxels->getBrickRange(3).first);
    EXPECT_EQ(20508.0, voxels->getBrickRange(3).second);
    EXPECT_EQ(1, source->reads);
    EXPECT_EQ(1u, voxels->getReadCount());
}

TEST(Voxels, ABrickIsReadOnceByManyThreads)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource({64, 64, 3});
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    ASSERT_TRUE(voxels->setBrickSize({9, 9, 3}).ok());
    const std::int64_t bricks = voxels->getLayout().brickCount();
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (std::int64_t i = 0; i < bricks; ++i) {
                EXPECT_TRUE(voxels->getBrick(i));
                voxels->getBrickRange(bricks - 1 - i);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(bricks, source->reads);
}

TEST(Voxels, DirtyMakesANewBlock)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource({9, 5, 5});
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    ASSERT_TRUE(voxels->setBrickSize({5, 5, 5}).ok());
    const Voxels::Block old = voxels->getBrick(0);
    const unsigned first = voxels->getModifiedCount(0), second = voxels->getModifiedCount(1);
    voxels->dirty(0);
    EXPECT_GT(voxels->getModifiedCount(0), first);
    EXPECT_EQ(second, voxels->getModifiedCount(1));
    EXPECT_NE(old.data, voxels->getBrick(0).data);
    EXPECT_EQ(0, at(old, 0));
    voxels->dirty();
    EXPECT_GT(voxels->getModifiedCount(1), second);
    // A new layout never goes back to a count that was used before.
    const unsigned before = voxels->getModifiedCount(0);
    ASSERT_TRUE(voxels->setBrickSize({9, 5, 5}).ok());
    EXPECT_GT(voxels->getModifiedCount(0), before);
}

TEST(Voxels, WhatIsKeptIsBoundedAndTheLastUsed)
{
    // 64 bricks of 1 MiB and some.
    osg::ref_ptr<FormulaSource> source = new FormulaSource({260, 260, 500});
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    ASSERT_TRUE(voxels->setBrickSize({66, 66, 126}).ok());
    const std::int64_t bricks = voxels->getLayout().brickCount();
    ASSERT_EQ(64, bricks);
    const Voxels::Block held = voxels->getBrick(0);
    std::vector<std::uint16_t> first;
    for (std::size_t i = 0; i < 100; ++i)
        first.push_back(at(held, i));
    for (std::int64_t i = 1; i < bricks; ++i) {
        ASSERT_TRUE(voxels->getBrick(i));
        EXPECT_LE(voxels->getCachedBytes(), Voxels::CACHE_BYTES);
    }
    EXPECT_GT(voxels->getCachedBytes(), Voxels::CACHE_BYTES / 2);
    EXPECT_EQ(bricks, source->reads);
    // The last one is there, the first one is read again, and the same.
    EXPECT_TRUE(voxels->getBrick(bricks - 1));
    EXPECT_EQ(bricks, source->reads);
    const Voxels::Block again = voxels->getBrick(0);
    EXPECT_EQ(bricks + 1, source->reads);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(first[i], at(again, i));
        EXPECT_EQ(first[i], at(held, i));
    }
    // Ranges are kept whatever becomes of the samples.
    for (int pass = 0; pass < 2; ++pass)
        for (std::int64_t i = 0; i < bricks; ++i)
            voxels->getBrickRange(i);
    EXPECT_LE(source->reads, 2 * bricks + 1);
    voxels->dirty();
    EXPECT_EQ(0u, voxels->getCachedBytes());
}

TEST(Voxels, ReleasedBricksAreReadAgainAndKeepTheirRange)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource({9, 5, 5});
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    voxels->getBrickRange(0);
    voxels->releaseBrick(0);
    EXPECT_EQ(40408.0, voxels->getBrickRange(0).second);
    EXPECT_EQ(1, source->reads);
    EXPECT_TRUE(voxels->getBrick(0));
    EXPECT_EQ(2, source->reads);
}

TEST(Voxels, MemoryIsSharedWhereItLiesInOnePiece)
{
    osg::ref_ptr<MemoryVoxelSource> source = memorySource({8, 8, 17});
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    EXPECT_EQ(source->data(), voxels->getBrick(0).data);
    ASSERT_TRUE(voxels->setBrickSize({8, 8, 9}).ok());
    const Voxels::Block upper = voxels->getBrick(1);
    EXPECT_EQ(static_cast<unsigned char*>(source->data()) + 2 * 8 * 8 * 8, upper.data);
    EXPECT_EQ(2u * 8 * 8 * 9, upper.bytes);
    ASSERT_TRUE(voxels->setBrickSize({5, 8, 17}).ok());
    const Voxels::Block cut = voxels->getBrick(0);
    EXPECT_NE(source->data(), cut.data);
    EXPECT_EQ(2u * 5 * 8 * 17, cut.bytes);
}

TEST(Voxels, ExternalMemoryIsReleasedWhenTheLastBlockIs)
{
    std::vector<std::uint16_t> values(8, 5);
    bool released = false;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(
        source->setExternal(description({2, 2, 2}), values.data(), [&] { released = true; }).ok());
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    Voxels::Block block = voxels->getBrick(0);
    voxels = nullptr;
    source = nullptr;
    EXPECT_FALSE(released);
    EXPECT_EQ(5, at(block, 7));
    block = Voxels::Block();
    EXPECT_TRUE(released);
}

TEST(Voxels, RangeDefaults)
{
    osg::ref_ptr<Voxels> bytes = new Voxels(memorySource({4, 4, 4}, VoxelType::UINT8).get());
    EXPECT_EQ(osg::Vec2d(0, 255), bytes->getRange());
    EXPECT_EQ(0u, bytes->getReadCount());
    osg::ref_ptr<Voxels> formula = new Voxels(new FormulaSource({9, 6, 3}));
    EXPECT_EQ(osg::Vec2d(0, 20508), formula->getRange());
    EXPECT_FALSE(formula->hasExplicitRange());
    ASSERT_TRUE(formula->setRange({-5.0, 5.0}).ok());
    EXPECT_EQ(osg::Vec2d(-5, 5), formula->getRange());
    EXPECT_TRUE(formula->hasExplicitRange());
    // One value only, and none at all.
    osg::ref_ptr<MemoryVoxelSource> floats = memorySource({2, 2, 2}, VoxelType::FLOAT32);
    osg::ref_ptr<Voxels> constant = new Voxels(floats.get());
    EXPECT_EQ(osg::Vec2d(0, 1), constant->getRange());
    auto* values = static_cast<float*>(floats->data());
    std::fill(values, values + 8, std::nanf(""));
    osg::ref_ptr<Voxels> holes = new Voxels(floats.get());
    EXPECT_EQ(osg::Vec2d(0, 1), holes->getRange());
    EXPECT_GT(holes->getBrickRange(0).first, holes->getBrickRange(0).second);
}

TEST(Voxels, RangeOfHugeValuesIsFinite)
{
    osg::ref_ptr<MemoryVoxelSource> source = memorySource({2, 1, 1}, VoxelType::FLOAT64);
    static_cast<double*>(source->data())[0] = -1.7e308;
    static_cast<double*>(source->data())[1] = 1.7e308;
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    EXPECT_TRUE(std::isfinite(voxels->getRange().y() - voxels->getRange().x()));
    EXPECT_LT(voxels->getRange().x(), voxels->getRange().y());
}

TEST(Voxels, RgbaRangeIsAlphas)
{
    VoxelSource::Description d = description({2, 1, 1}, VoxelType::UINT8);
    d.components = 4;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(d).ok());
    auto* bytes = static_cast<unsigned char*>(source->data());
    bytes[0] = 200, bytes[3] = 7, bytes[7] = 9;
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    EXPECT_EQ(std::make_pair(7.0, 9.0), voxels->getBrickRange(0));
}

TEST(Voxels, AFailingSourceIsAskedOnce)
{
    for (const bool throws : {false, true}) {
        clearLastError();
        osg::ref_ptr<FormulaSource> source = new FormulaSource({4, 4, 4});
        source->fails = true;
        source->throws = throws;
        osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
        voxels->setFileName("head.tif");
        EXPECT_FALSE(voxels->getBrick(0));
        EXPECT_FALSE(voxels->getBrick(0));
        EXPECT_GT(voxels->getBrickRange(0).first, voxels->getBrickRange(0).second);
        EXPECT_EQ(1, source->reads);
        EXPECT_EQ(ErrorCode::FILE_UNREADABLE, getLastError().code);
        EXPECT_NE(std::string::npos, getLastError().text.find("brick 0 of head.tif"));
        source->fails = source->throws = false;
        voxels->dirty(0);
        EXPECT_TRUE(voxels->getBrick(0));
    }
}

TEST(Voxels, RefusalsLeaveEverythingAsItWas)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(memorySource({4, 4, 4}).get());
    const unsigned layout = voxels->getLayoutCount();
    for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)})
        EXPECT_EQ(ErrorCode::VALUE_INVALID, voxels->setSpacing({1.0, bad, 1.0}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, voxels->setOrigin({0.0, NAN, 0.0}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, voxels->setRange({1.0, 1.0}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, voxels->setRange({NAN, 1.0}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, voxels->setRange({0.0, INFINITY}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, voxels->setBrickSize({4, 1, 4}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, voxels->setOverlap(-1).code);
    EXPECT_EQ(layout, voxels->getLayoutCount());
    EXPECT_EQ(osg::Vec3d(1, 1, 1), voxels->getSpacing());
    EXPECT_EQ(osg::Vec3i(256, 256, 256), voxels->getBrickSize());
    EXPECT_FALSE(voxels->getBrick(1));
    EXPECT_FALSE(voxels->getBrick(-1));
}

TEST(Voxels, WithoutASourceTheyAreEmpty)
{
    osg::ref_ptr<Voxels> voxels = new Voxels;
    EXPECT_FALSE(voxels->valid());
    EXPECT_EQ(0, voxels->getLayout().brickCount());
    EXPECT_FALSE(voxels->getBrick(0));
    EXPECT_EQ(osg::Vec2d(0, 1), voxels->getRange());
    ASSERT_TRUE(voxels->setBrickSize({32, 32, 32}).ok());
    ASSERT_TRUE(voxels->setSource(memorySource({40, 40, 40}).get()).ok());
    EXPECT_EQ(8, voxels->getLayout().brickCount());
    ASSERT_TRUE(voxels->setSource(nullptr).ok());
    EXPECT_FALSE(voxels->valid());
}

TEST(Voxels, ManyBricksCostNothingUntilTheyAreAskedFor)
{
    osg::ref_ptr<FormulaSource> source = new FormulaSource({2000, 2000, 2000});
    osg::ref_ptr<Voxels> voxels = new Voxels(source.get());
    ASSERT_TRUE(voxels->setBrickSize({33, 33, 33}).ok());
    EXPECT_EQ(std::int64_t(63) * 63 * 63, voxels->getLayout().brickCount());
    EXPECT_TRUE(voxels->getBrick(voxels->getLayout().brickCount() - 1));
    EXPECT_EQ(1, source->reads);
}

TEST(Voxels, CopiesShareTheSource)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(memorySource({4, 4, 4}).get());
    ASSERT_TRUE(voxels->setRange({3.0, 9.0}).ok());
    voxels->setFileName("a.tif");
    osg::ref_ptr<Voxels> copy = osg::clone(voxels.get());
    EXPECT_EQ(voxels->getSource(), copy->getSource());
    EXPECT_EQ(osg::Vec2d(3, 9), copy->getRange());
    EXPECT_EQ("a.tif", copy->getFileName());
    EXPECT_TRUE(copy->getBrick(0));
}

TEST(Voxels, RenderDataIsMadeOnceAndForwardedTo)
{
    struct Data : RenderData
    {
        void resizeGLObjectBuffers(unsigned int maximum) override { resized = maximum; }
        void releaseGLObjects(osg::State*) const override { ++released; }
        unsigned resized = 0;
        mutable int released = 0;
    };
    osg::ref_ptr<Voxels> voxels = new Voxels;
    voxels->releaseGLObjects(); // none yet
    EXPECT_FALSE(RenderDataAccess::slot(*voxels).get().valid());
    int made = 0;
    const auto make = [&] {
        ++made;
        return osg::ref_ptr<RenderData>(new Data);
    };
    const auto data = RenderDataAccess::slot(*voxels).getOrCreate(make);
    EXPECT_EQ(data, RenderDataAccess::slot(*voxels).getOrCreate(make));
    EXPECT_EQ(1, made);
    voxels->resizeGLObjectBuffers(7);
    voxels->releaseGLObjects();
    EXPECT_EQ(7u, static_cast<Data*>(data.get())->resized);
    EXPECT_EQ(1, static_cast<Data*>(data.get())->released);
}

TEST(MemoryVoxelSource, Refusals)
{
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    std::uint16_t value = 0;
    EXPECT_EQ(ErrorCode::VALUE_INVALID, source->read({{0, 0, 0}, {1, 1, 1}}, &value).code);
    EXPECT_EQ(ErrorCode::TOO_LARGE,
              source->allocate(description({1 << 14, 1 << 13, 1 << 13})).code);
    EXPECT_EQ(ErrorCode::TOO_LARGE,
              source->allocate(description({2147483647, 2147483647, 2147483647})).code);
    EXPECT_EQ(ErrorCode::TOO_LARGE, source->allocate(description({3, 3, 3}), 53).code);
    EXPECT_EQ(nullptr, source->data());
    EXPECT_EQ(ErrorCode::VALUE_INVALID, source->allocate(description({3, 0, 3})).code);
    VoxelSource::Description two = description({3, 3, 3});
    two.components = 2;
    EXPECT_EQ(ErrorCode::VALUE_INVALID, source->allocate(two).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID,
              source->allocate(description({3, 3, 3}, static_cast<VoxelType>(77))).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, source->setExternal(description({3, 3, 3}), nullptr).code);
    ASSERT_TRUE(source->allocate(description({3, 3, 3})).ok());
    EXPECT_EQ(ErrorCode::INDEX_OUT_OF_RANGE, source->read({{2, 2, 2}, {4, 3, 3}}, &value).code);
    EXPECT_FALSE(source->share({{2, 2, 2}, {4, 3, 3}}));
}

TEST(MemoryVoxelSource, DeepCopyHasItsOwnVoxels)
{
    osg::ref_ptr<MemoryVoxelSource> source = memorySource({2, 2, 2});
    static_cast<std::uint16_t*>(source->data())[7] = 42;
    osg::ref_ptr<MemoryVoxelSource> shallow = new MemoryVoxelSource(*source);
    osg::ref_ptr<MemoryVoxelSource> deep =
        new MemoryVoxelSource(*source, osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_EQ(source->data(), shallow->data());
    EXPECT_NE(source->data(), deep->data());
    EXPECT_EQ(42, static_cast<std::uint16_t*>(deep->data())[7]);
}

TEST(Voxels, AnOverlapThatIsRequiredIsRaisedOnly)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(40);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(description));
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    // One brick: nothing is read again for it.
    const unsigned modified = voxels->getModifiedCount(0);
    EXPECT_TRUE(voxels->requireOverlap(3).ok());
    EXPECT_EQ(3, voxels->getOverlap());
    EXPECT_EQ(modified, voxels->getModifiedCount(0));
    ASSERT_TRUE(voxels->setBrickSize({10, 10, 10}));
    EXPECT_TRUE(voxels->requireOverlap(1).ok());
    EXPECT_EQ(3, voxels->getOverlap());
    EXPECT_TRUE(voxels->requireOverlap(5).ok());
    EXPECT_EQ(5, voxels->getOverlap());
    EXPECT_EQ(5, voxels->getLayout().brick(0).samples.max.x -
                     voxels->getLayout().brick(1).samples.min.x);
    // Bricks that are too small keep what they have, and nobody is told twice.
    clearLastError();
    EXPECT_FALSE(voxels->requireOverlap(10).ok());
    EXPECT_EQ(5, voxels->getOverlap());
    EXPECT_TRUE(getLastError().ok());
}

} // namespace VoxelsTest
