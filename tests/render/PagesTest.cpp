// Voxels that are read in the background, page by page, within budgets.

#include "Volumes.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/render/textures/PageQueue.h>

#include <support/GLTest.h>
#include <support/Reports.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace PagesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int PAGE = 16;

// Samples of a function, whose levels are its values at their places: what a smooth function's
// means are, nearly.
class FormulaSource : public VoxelSource
{
public:
    using Function = std::function<double(const glm::dvec3&)>;

    FormulaSource(int size, Function value, VoxelType type = VoxelType::FLOAT32)
        : _value(std::move(value))
    {
        _description.size = glm::ivec3(size);
        _description.type = type;
    }
    META_Object(osgVolumizer, FormulaSource);
    FormulaSource() = default;
    FormulaSource(const FormulaSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op), _description(o._description), _value(o._value)
    {
    }

    Description describe() const override { return _description; }
    int levelCount() const override { return core::BrickTree::levelsFor(_description.size, PAGE); }
    int pageSize() const override { return PAGE; }
    Status read(const core::Box3i& region, void* destination) const override
    {
        return readLevel(0, region, destination);
    }
    Status readLevel(int level, const core::Box3i& region, void* destination) const override
    {
        if (level < int(reads.size())) ++reads[std::size_t(level)];
        {
            std::unique_lock<std::mutex> lock(_mutex);
            ++_waiting;
            _changed.notify_all();
            _changed.wait(lock, [&] { return level >= _open; });
            --_waiting;
        }
        if (failEvery > 0 && ++_calls % failEvery == 0)
            return {ErrorCode::FILE_UNREADABLE, "the disk is dead"};
        if (level < failBelow) return {ErrorCode::FILE_UNREADABLE, "the disk is dead"};
        std::vector<double> values;
        const double spacing = 1 << level, offset = 0.5 * (spacing - 1.0);
        const double top = _description.type == VoxelType::UINT8 ? 255.0 : 1.0;
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    values.push_back(top * _value(spacing * glm::dvec3(x, y, z) + offset));
        const auto bytes = oracle::fromDoubles(values, _description.type);
        std::copy(bytes.begin(), bytes.end(), static_cast<unsigned char*>(destination));
        return {};
    }
    std::optional<std::pair<double, double>> levelRange(int level,
                                                        const core::Box3i& region) const override
    {
        if (range) return range(level, region);
        return std::nullopt;
    }
    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override
    {
        return levelRange(0, region);
    }

    // Levels below `level` are answered only once this is called again.
    void openFrom(int level) const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _open = level;
        _changed.notify_all();
    }
    void waitForReader() const
    {
        std::unique_lock<std::mutex> lock(_mutex);
        _changed.wait_for(lock, std::chrono::seconds(200), [&] { return _waiting > 0; });
    }

    mutable std::array<std::atomic<int>, 8> reads{}; // by level
    int failEvery = 0;
    std::atomic<int> failBelow{0};
    std::function<std::optional<std::pair<double, double>>(int, const core::Box3i&)> range;

private:
    Description _description;
    Function _value;
    mutable std::mutex _mutex;
    mutable std::condition_variable _changed;
    mutable int _open = 0, _waiting = 0;
    mutable std::atomic<int> _calls{0};
};

// Smooth, and with something everywhere.
double waves(const glm::dvec3& p)
{
    return 0.5 + 0.2 * std::sin(0.11 * p.x) + 0.2 * std::cos(0.07 * p.y + 0.05 * p.z);
}

RenderOptions viewOf(double size, const osg::Vec3d& eye)
{
    const double middle = 0.5 * (size - 1.0);
    return RenderOptions().size(96, 80).perspective(40.0).lookAt(
        eye, osg::Vec3d(middle, middle, middle), {0, 0, 1});
}

osg::ref_ptr<A> volumeOf(VoxelSource* source)
{
    const osg::ref_ptr<Voxels> voxels = new Voxels(source);
    if (voxels->getType() == VoxelType::FLOAT32) voxels->setRange(osg::Vec2d(0.0, 1.0));
    const osg::ref_ptr<A> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(smoothPoints(0.05)));
    return volume;
}

std::size_t covered(const FloatImage& picture)
{
    return support::coveredPixels(picture).count();
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Draws frames until a condition holds of one; the last picture. Only what never ends takes as long
// as the limit.
FloatImage renderUntil(support::SceneRenderer& renderer,
                       const std::function<bool(const FloatImage&)>& condition)
{
    constexpr double LIMIT = 200.0; // seconds
    const auto start = std::chrono::steady_clock::now();
    FloatImage picture = renderer.render();
    while (!condition(picture) && secondsSince(start) < LIMIT) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        picture = renderer.render();
    }
    return picture;
}

// Until nothing is missing.
FloatImage settle(support::SceneRenderer& renderer)
{
    return renderUntil(renderer, [&renderer](const FloatImage&) {
        return renderer.counters()["osgVolumizer pages missing"] == 0.0;
    });
}

double largest(const FloatImage& a, const FloatImage& b)
{
    return support::compare(a, b, support::coveredPixels(a) | support::coveredPixels(b)).maximum;
}

class Pages : public support::GLTest
{
protected:
    void TearDown() override { setPagingBudget(defaultPagingBudget()); }
    static void setBudget(std::int64_t memoryBytes, std::int64_t textureBytes)
    {
        PagingBudget budget = defaultPagingBudget();
        budget.memoryBytes = memoryBytes;
        budget.textureBytes = textureBytes;
        budget.threads = 3;
        ASSERT_TRUE(setPagingBudget(budget));
    }
};

} // namespace

TEST_F(Pages, AtRestThePictureIsThatOfAVolumeInMemory)
{
    constexpr int size = 70;
    const osg::ref_ptr<Voxels> inMemory = makeVoxels(glm::ivec3(size), waves);
    const osg::ref_ptr<A> expected = makeVolume(inMemory);
    expected->setLookupTable(makeTable(smoothPoints(0.05)));
    for (const osg::Vec3d& eye : {osg::Vec3d(150, -90, 110), {-60, 20, 45}, {35, 30, 38}}) {
        const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
        support::SceneRenderer renderer(volumeOf(source), viewOf(size, eye));
        const FloatImage picture = settle(renderer);
        EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
        EXPECT_EQ(renderer.counters()["osgVolumizer pages waited for"], 0.0);
        EXPECT_GT(source->reads[0], 0);
        const FloatImage there = support::renderScene(expected, viewOf(size, eye));
        EXPECT_LT(largest(picture, there), 1e-4);
        support::savePicture(picture, "pages_at_rest");
        // And stays as it is.
        const int before = source->reads[0];
        EXPECT_EQ(largest(renderer.render(), picture), 0.0);
        EXPECT_EQ(source->reads[0], before);
    }
}

TEST_F(Pages, SlicesShowTheSame)
{
    constexpr int size = 50;
    const RenderOptions view = viewOf(size, {90, -60, 70});
    const osg::ref_ptr<Voxels> bricked = makeVoxels(glm::ivec3(size), waves);
    ASSERT_TRUE(bricked->setBrickSize({PAGE + 1, PAGE + 1, PAGE + 1}));
    const osg::ref_ptr<A> expected = makeVolume(bricked);
    const osg::ref_ptr<A> paged = volumeOf(new FormulaSource(size, waves));
    for (const osg::ref_ptr<A>& volume : {expected, paged}) {
        volume->setLookupTable(makeTable(smoothPoints(0.05)));
        volume->setTechnique(A::SLICES);
    }
    support::SceneRenderer renderer(paged, view);
    const FloatImage picture = settle(renderer), there = support::renderScene(expected, view);
    EXPECT_LT(largest(picture, there), 1e-5);
}

TEST_F(Pages, NoFrameWaitsForARead)
{
    constexpr int size = 70;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    source->openFrom(8); // nothing
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {150, -90, 110}));
    for (int frame = 0; frame < 20; ++frame)
        EXPECT_EQ(covered(renderer.render()), 0u);
    source->waitForReader();
    EXPECT_GT(renderer.counters()["osgVolumizer pages missing"], 0.0);
    // The coarse levels come, the finest does not.
    source->openFrom(1);
    const auto isShown = [](const FloatImage& picture) { return covered(picture) > 1000; };
    const FloatImage coarse = renderUntil(renderer, isShown);
    EXPECT_TRUE(isShown(coarse));
    source->openFrom(0);
    const FloatImage fine = settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    // What was shown meanwhile was nearly that: there is no hole in it.
    const auto difference = support::compare(coarse, fine, support::coveredPixels(fine));
    EXPECT_LT(difference.rmse, 0.03);
    EXPECT_LT(difference.maximum, 0.15);
}

TEST_F(Pages, BudgetsHoldInEveryFrameOfAFlight)
{
    constexpr int size = 500;
    constexpr std::int64_t MEGABYTE = 1 << 20, MEMORY = 2 * MEGABYTE, TEXTURES = 3 * MEGABYTE;
    setBudget(MEMORY, TEXTURES);
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {700, -400, 600}));
    settle(renderer);
    for (int frame = 0; frame < 60; ++frame) {
        const double a = 0.1 * frame, r = 600.0 - 8.0 * frame;
        renderer.options().lookAt({250 + r * std::cos(a), 250 + r * std::sin(a), 300.0},
                                  {250, 250, 250}, {0, 0, 1});
        EXPECT_GT(covered(renderer.render()), 1000u);
        auto counters = renderer.counters();
        EXPECT_LE(counters["osgVolumizer bytes of pages"], double(MEMORY));
        EXPECT_LE(counters["osgVolumizer bytes of page textures"], double(TEXTURES));
        EXPECT_EQ(counters["osgVolumizer pages failed"], 0.0);
    }
    const FloatImage picture = settle(renderer);
    auto counters = renderer.counters();
    EXPECT_EQ(counters["osgVolumizer pages missing"], 0.0);
    // So much could not be held.
    EXPECT_GT(source->reads[0] * PAGE * PAGE * PAGE, MEMORY);
    EXPECT_GT(counters["osgVolumizer bytes of page textures"], 0.0);
    support::savePicture(picture, "pages_flight");
}

TEST_F(Pages, FromAfarNothingFinerThanPixelsIsRead)
{
    constexpr int size = 500;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {2500, -1500, 1800}));
    settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    EXPECT_EQ(source->reads[0], 0);
    EXPECT_EQ(source->reads[1], 0);
    EXPECT_GT(source->reads[3] + source->reads[4], 0);
}

// A source that knows its ranges: what shows nothing is not read, nor is what has one value.
TEST_F(Pages, EmptyAndUniformPagesAreNotRead)
{
    constexpr int size = 128;
    // Nothing outside a ball, one value inside of it, and a rim.
    const auto ball = [](const glm::dvec3& p) {
        const double r = glm::length(p - 63.5);
        return r > 40.0 ? 0.0 : r < 30.0 ? 1.0 : 0.1 * (40.0 - r);
    };
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, ball, VoxelType::UINT8);
    source->range = [](int level, const core::Box3i& region) {
        const double spacing = 1 << level;
        const glm::dvec3 low = spacing * glm::dvec3(region.min);
        const glm::dvec3 high = spacing * glm::dvec3(region.max);
        const glm::dvec3 nearest = glm::clamp(glm::dvec3(63.5), low, high);
        const glm::dvec3 farthest = glm::max(glm::abs(low - 63.5), glm::abs(high - 63.5));
        const double a = glm::length(nearest - 63.5), b = glm::length(farthest);
        return std::optional<std::pair<double, double>>(std::in_place,
                                                        b < 30.0   ? 255.0
                                                        : b > 40.0 ? 0.0
                                                                   : 25.5 * (40.0 - b),
                                                        a > 40.0   ? 0.0
                                                        : a < 30.0 ? 255.0
                                                                   : 25.5 * (40.0 - a));
    };
    const RenderOptions view = viewOf(size, {220, -120, 160}).size(320, 260);
    support::SceneRenderer renderer(volumeOf(source), view);
    const FloatImage picture = settle(renderer);
    auto counters = renderer.counters();
    EXPECT_EQ(counters["osgVolumizer pages missing"], 0.0);
    EXPECT_GT(counters["osgVolumizer bricks empty"], 50.0);
    EXPECT_GT(counters["osgVolumizer bricks homogeneous"], 0.0);
    EXPECT_LT(source->reads[0], 450); // of 512
    const osg::ref_ptr<FormulaSource> all = new FormulaSource(size, ball, VoxelType::UINT8);
    support::SceneRenderer other(volumeOf(all), view);
    EXPECT_LT(largest(picture, settle(other)), 2e-4);
    EXPECT_EQ(all->reads[0], 512);
}

TEST_F(Pages, ADiskThatFailsNowAndThenIsAskedAgain)
{
    constexpr int size = 70;
    const support::Reports reports;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
    source->failEvery = 5;
    const RenderOptions view = viewOf(size, {150, -90, 110});
    support::SceneRenderer renderer(volumeOf(source), view);
    const FloatImage picture = settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    const osg::ref_ptr<A> expected = makeVolume(makeVoxels(glm::ivec3(size), waves));
    expected->setLookupTable(makeTable(smoothPoints(0.05)));
    EXPECT_LT(largest(picture, support::renderScene(expected, view)), 1e-4);
    EXPECT_EQ(reports.count("the disk is dead"), 1);
}

TEST_F(Pages, ADeadDiskLeavesACoarsePictureAndOneMessage)
{
    constexpr int size = 70;
    const support::Reports reports;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves, VoxelType::UINT8);
    source->failBelow = 1;
    support::SceneRenderer renderer(volumeOf(source), viewOf(size, {150, -90, 110}));
    const auto start = std::chrono::steady_clock::now();
    renderUntil(renderer, [&](const FloatImage& picture) {
        return covered(picture) > 1000 && source->reads[0] > 200;
    });
    const double pages = renderer.counters()["osgVolumizer pages wanted"];
    EXPECT_GT(renderer.counters()["osgVolumizer pages failed"], 0.0);
    EXPECT_EQ(reports.count("the disk is dead"), 1);
    // It is asked again after a while, each time twice as long, not in every frame.
    EXPECT_LT(source->reads[0], pages * (2.0 + std::log2(1.0 + secondsSince(start) / 0.25)));
    source->failBelow = 0;
    settle(renderer);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
}

TEST_F(Pages, ChangedDataAreReadAgain)
{
    constexpr int size = 40;
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(size, waves);
    const osg::ref_ptr<A> volume = volumeOf(source);
    support::SceneRenderer renderer(volume, viewOf(size, {80, -60, 70}));
    settle(renderer);
    const int before = source->reads[0];
    volume->getVoxels()->dirty();
    renderer.render();
    settle(renderer);
    EXPECT_EQ(source->reads[0], 2 * before);
}

TEST_F(Pages, RefusedBudgetsChangeNothing)
{
    const support::Reports reports;
    const PagingBudget before = getPagingBudget();
    for (int i = 0; i < 5; ++i) {
        PagingBudget bad = before;
        if (i == 0) bad.memoryBytes = 1000;
        if (i == 1) bad.textureBytes = -1;
        if (i == 2) bad.uploadMilliseconds = 0.0;
        if (i == 3) bad.threads = 0;
        if (i == 4) bad.threads = 65;
        EXPECT_EQ(Status(setPagingBudget(bad)).code, ErrorCode::VALUE_INVALID);
    }
    EXPECT_EQ(getPagingBudget().threads, before.threads);
    EXPECT_EQ(getPagingBudget().memoryBytes, before.memoryBytes);
}

} // namespace PagesTest
