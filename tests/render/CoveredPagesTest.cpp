// Pages that opaque pages in front of them hide are neither read nor missing; and pages that will
// come into view are read before.

#include "PagedScene.h"

#include <osgVolumizer/Paging.h>

#include <osg/ClipControl>
#include <osg/Depth>

#include <support/GLTest.h>

#include <array>
#include <map>
#include <memory>
#include <mutex>

namespace CoveredPagesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using namespace osgVolumizer::test::paged;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 128;
const osg::Vec3d EYE(20, -250, 90);

RenderOptions viewFrom(const osg::Vec3d& eye)
{
    return viewOf(SIZE, eye).size(160, 140);
}

// Hills under the air, wavy inside.
double hills(const glm::dvec3& p)
{
    const double depth = 90.0 + 6.0 * std::sin(0.1 * p.x) * std::cos(0.08 * p.y) - p.z;
    const double waves = 0.03 * std::sin(0.4 * p.x) * std::cos(0.3 * p.y);
    return std::clamp(0.5 + depth / 20.0, 0.0, 0.9) + (depth > 8.0 ? waves : 0.0);
}

// What a page stands for, from its samples and those around them.
osg::ref_ptr<FormulaSource> sourceOf(VoxelType type = VoxelType::UINT8)
{
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, hills, type);
    const double top = type == VoxelType::UINT8 ? 255.0 : 1.0;
    using Range = std::pair<double, double>;
    using Key = std::array<int, 7>;
    struct Known
    {
        std::mutex mutex;
        std::map<Key, Range> ranges;
    };
    source->range = [top, known = std::make_shared<Known>()](int level, const core::Box3i& s) {
        std::lock_guard<std::mutex> lock(known->mutex);
        const Key key{level, s.min.x, s.min.y, s.min.z, s.max.x, s.max.y, s.max.z};
        const auto found = known->ranges.find(key);
        if (found != known->ranges.end()) return found->second;
        const double spacing = 1 << level;
        Range range(1.0, 0.0);
        for (int z = s.min.z; z <= s.max.z; ++z)
            for (int y = s.min.y; y <= s.max.y; ++y)
                for (int x = s.min.x; x <= s.max.x; ++x) {
                    const double v = hills(spacing * (glm::dvec3(x, y, z)));
                    range = {std::min(range.first, v), std::max(range.second, v)};
                }
        const double margin = 0.06 * spacing; // more than they change by to either side
        range = {std::floor(top * std::max(range.first - margin, 0.0)),
                 std::ceil(top * std::min(range.second + margin, 1.0))};
        return known->ranges[key] = range;
    };
    return source;
}

// Opaque above a half of the range.
osg::ref_ptr<LookupTable> solid(double opacity)
{
    return makeTable({{0.0, {1, 1, 1, 0}},
                      {0.45, {1, 1, 1, 0}},
                      {0.55, {1, 0.8, 0.6, opacity}},
                      {1.0, {0.4, 0.2, 0.1, opacity}}});
}

osg::ref_ptr<A> volumeOf(VoxelSource* source, double opacity)
{
    const osg::ref_ptr<A> volume = paged::volumeOf(source);
    volume->setLookupTable(solid(opacity));
    return volume;
}

class CoveredPages : public support::GLTest
{
protected:
    void TearDown() override { setPagingBudget(defaultPagingBudget()); }

    struct Outcome
    {
        int reads = 0;
        double hidden = 0.0;
        FloatImage picture;
    };
    static Outcome settleFrom(const osg::Vec3d& eye, double opacity, bool ranges,
                              VoxelType type = VoxelType::UINT8)
    {
        const osg::ref_ptr<FormulaSource> source = sourceOf(type);
        if (!ranges) source->range = {};
        const osg::ref_ptr<A> volume = volumeOf(source, opacity);
        support::SceneRenderer renderer(volume, viewFrom(eye));
        Outcome outcome;
        outcome.picture = settle(renderer);
        outcome.reads = readsOf(*source);
        outcome.hidden = renderer.counters()["osgVolumizer pages hidden"];
        return outcome;
    }
};

} // namespace

TEST_F(CoveredPages, ThoseBehindAreNotReadAndThePictureIsTheSame)
{
    for (const osg::Vec3d& eye :
         {EYE, osg::Vec3d(63.5, 380, 63.5), osg::Vec3d(300, 250, -120), osg::Vec3d(63, 63, 300)}) {
        const Outcome with = settleFrom(eye, 1.0, true);
        const Outcome without = settleFrom(eye, 1.0, false);
        const Outcome clear = settleFrom(eye, 0.2, true); // shows in the same places
        EXPECT_EQ(without.hidden, 0.0);
        EXPECT_GT(with.hidden, 10.0);
        EXPECT_LT(with.reads, 0.7 * clear.reads) << eye.x() << " of " << clear.reads;
        EXPECT_LT(largest(with.picture, without.picture), 1e-4) << eye.x();
        support::savePicture(with.picture, "covered_pages");
    }
}

TEST_F(CoveredPages, WhatLetsLightThroughCoversNothing)
{
    const Outcome clear = settleFrom(EYE, 0.2, true);
    EXPECT_EQ(clear.hidden, 0.0);
    EXPECT_LT(largest(clear.picture, settleFrom(EYE, 0.2, false).picture), 1e-4);
    // Floats may have holes, of which a range says nothing.
    EXPECT_EQ(settleFrom(EYE, 1.0, true, VoxelType::FLOAT32).hidden, 0.0);
}

// Ways in which what is in front is not drawn, or does not hide.
TEST_F(CoveredPages, OnlyWhatIsDrawnCovers)
{
    const auto hidden = [](const std::function<void(A&)>& change,
                           const std::function<void(RenderOptions&)>& look = {}) {
        const osg::ref_ptr<A> volume = volumeOf(sourceOf(), 1.0);
        change(*volume);
        RenderOptions view = viewFrom(EYE);
        if (look) look(view);
        support::SceneRenderer renderer(volume, view);
        settle(renderer);
        return renderer.counters()["osgVolumizer pages hidden"];
    };
    EXPECT_GT(hidden([](A&) {}), 20.0);
    EXPECT_EQ(hidden([](A& a) { a.setRayFunction(A::MAXIMUM); }), 0.0);
    EXPECT_EQ(hidden([](A& a) {
                  a.getOrCreateStateSet()->setAttribute(new osg::Depth(osg::Depth::GREATER));
              }),
              0.0);
    // From within there is nothing in front.
    EXPECT_GT(hidden([](A&) {},
                     [](RenderOptions& o) {
                         o.lookAt({63.5, 63.5, 63.5}, {63.5, 200, 63.5}, {0, 0, 1});
                     }),
              0.0);
}

// The far side is read when it comes into view.
TEST_F(CoveredPages, WhatComesIntoViewIsRead)
{
    const osg::ref_ptr<FormulaSource> source = sourceOf();
    support::SceneRenderer renderer(volumeOf(source, 1.0), viewFrom(EYE));
    settle(renderer);
    const int before = readsOf(*source);
    renderer.options().lookAt({100, 380, 40}, {63.5, 63.5, 63.5}, {0, 0, 1});
    const FloatImage picture = settle(renderer);
    EXPECT_GT(readsOf(*source), before + 20);
    EXPECT_LT(largest(picture, settleFrom({100, 380, 40}, 1.0, false).picture), 1e-4);
}

TEST_F(CoveredPages, PagesAreReadWhereTheCameraMoves)
{
    const osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, waves);
    const RenderOptions base = viewFrom(EYE).perspective(12.0);
    support::SceneRenderer renderer(paged::volumeOf(source), base);
    const auto lookAt = [&](double x) {
        renderer.options().lookAt(EYE, {x, 63.5, 63.5}, {0, 0, 1});
    };
    const auto ahead = [&] { return renderer.counters()["osgVolumizer pages ahead"]; };
    // All that either of two neighbouring views needs is there.
    for (const double x : {34.0, 30.0}) {
        lookAt(x);
        settle(renderer);
    }
    renderer.render();
    EXPECT_EQ(ahead(), 0.0) << "at rest";
    source->give(0);
    const int before = readsOf(*source);
    lookAt(34.0); // on its way to 66
    renderer.render();
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    EXPECT_GT(ahead(), 4.0);
    source->waitForReader();
    EXPECT_GT(readsOf(*source), before);
    // It stops: nothing more is asked for than what is under way.
    renderer.render();
    EXPECT_EQ(ahead(), 0.0);
    source->giveAll();
}

} // namespace CoveredPagesTest
