#include "osgVolumizer/core/sampling/FaceCache.h"
#include "TestGeometry.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace FaceCacheTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

namespace {

View turned(double angle)
{
    View v = viewAlong({1, 2, 3});
    v.toEye = glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 1, 0)) * v.toEye;
    return v;
}

const std::vector<Box3d> BOXES{{{0, 0, 0}, {8, 8, 8}}};

std::shared_ptr<const TetraSet> box()
{
    return std::make_shared<TetraSet>(makeBox(glm::dvec3(0.0), glm::dvec3(8.0)));
}

/// A cache of which calls are counted.
class Counted
{
public:
    Result<FaceCache::FacesPtr> faces(FaceCache::ViewId viewId,
                                      const std::shared_ptr<const TetraSet>& set,
                                      const std::vector<Box3d>& boxes, const View& view,
                                      const SamplingParameters& parameters, double slackAngle = 0.0)
    {
        bool polygonized = true;
        auto r = _cache.faces(viewId, set, boxes, view, parameters, slackAngle, &polygonized);
        ++(polygonized ? _polygonizations : _reuses);
        return r;
    }
    unsigned polygonizations() const { return _polygonizations; }
    unsigned reuses() const { return _reuses; }

private:
    FaceCache _cache;
    std::atomic<unsigned> _polygonizations{0}, _reuses{0};
};

} // namespace

TEST(FaceCache, UnchangedViewsShareFaces)
{
    Counted cache;
    const auto set = box();
    const SamplingParameters p;
    const FaceCache::FacesPtr a = *cache.faces(1, set, BOXES, turned(0.0), p);
    ASSERT_TRUE(a);
    EXPECT_EQ(*cache.faces(1, set, BOXES, turned(0.0), p), a);
    // Moving sideways and zooming change nothing in planes across the view.
    View moved = turned(0.0);
    moved.toEye[3].x += 5.0;
    moved.projection = glm::perspective(0.3, 2.0, 1.0, 900.0);
    EXPECT_EQ(*cache.faces(1, set, BOXES, moved, p), a);
    EXPECT_EQ(cache.polygonizations(), 1u);
    EXPECT_EQ(cache.reuses(), 2u);
}

TEST(FaceCache, EveryInputCounts)
{
    Counted cache;
    const auto set = box();
    const SamplingParameters p;
    EXPECT_TRUE(cache.faces(1, set, BOXES, turned(0.0), p));
    EXPECT_TRUE(cache.faces(2, set, BOXES, turned(0.0), p)); // another view
    EXPECT_EQ(cache.polygonizations(), 2u);
    EXPECT_TRUE(
        cache.faces(1, box(), BOXES, turned(0.0), p)); // another set, though it looks the same
    EXPECT_EQ(cache.polygonizations(), 3u);
    EXPECT_TRUE(cache.faces(1, set, {}, turned(0.0), p));
    EXPECT_EQ(cache.polygonizations(), 4u);
    SamplingParameters finer = p;
    finer.periodVoxel.y = 0.5;
    EXPECT_TRUE(cache.faces(1, set, {}, turned(0.0), finer));
    EXPECT_EQ(cache.polygonizations(), 5u);
    EXPECT_TRUE(cache.faces(1, set, {}, turned(1e-6), finer));
    EXPECT_EQ(cache.polygonizations(), 6u);
    View nearer = turned(1e-6); // the depths that are reported differ
    nearer.toEye[3].z += 1.0;
    EXPECT_TRUE(cache.faces(1, set, {}, nearer, finer));
    EXPECT_EQ(cache.polygonizations(), 7u);
    finer.space = SamplingSpace::VIEW_VOLUME;
    EXPECT_TRUE(cache.faces(1, set, {}, nearer, finer));
    nearer.projection = glm::perspective(0.3, 2.0, 1.0, 900.0);
    EXPECT_TRUE(cache.faces(1, set, {}, nearer, finer));
    EXPECT_EQ(cache.polygonizations(), 9u);
    EXPECT_TRUE(cache.faces(2, set, BOXES, turned(0.0), p)); // still as it was
    EXPECT_EQ(cache.polygonizations(), 9u);
}

TEST(FaceCache, SlackIsMeasuredFromWhereTheFacesWereMade)
{
    Counted cache;
    const auto set = box();
    const SamplingParameters p;
    for (int i = 0; i <= 20; ++i)
        EXPECT_TRUE(cache.faces(1, set, BOXES, turned(0.01 * i), p, 0.0501));
    EXPECT_EQ(cache.polygonizations(), 4u); // at 0, 6, 12, 18 hundredths
    EXPECT_EQ(cache.faces(1, set, BOXES, turned(0.0), p, -1.0).status.code,
              ErrorCode::VALUE_INVALID);
}

TEST(FaceCache, VoxelAxesNeedNoNewFacesWhileTheAxisHolds)
{
    Counted cache;
    const auto set = box();
    SamplingParameters p;
    p.mode = SamplingMode::AXIS_ALIGNED;
    for (int i = 0; i < 10; ++i)
        EXPECT_TRUE(cache.faces(1, set, BOXES, turned(0.01 * i), p));
    EXPECT_EQ(cache.polygonizations(), 1u);
    View inside; // the order of the planes depends on the eye
    inside.projection = glm::perspective(1.0, 1.0, 0.1, 100.0);
    inside.toEye = glm::lookAt(glm::dvec3(4.0, 4.0, 3.0), glm::dvec3(4.5, 4.0, 20.0), {0, 1, 0});
    EXPECT_TRUE(cache.faces(1, set, BOXES, inside, p));
    inside.toEye = glm::lookAt(glm::dvec3(4.0, 4.0, 5.0), glm::dvec3(4.5, 4.0, 20.0), {0, 1, 0});
    EXPECT_TRUE(cache.faces(1, set, BOXES, inside, p));
    EXPECT_EQ(cache.polygonizations(), 3u);
}

TEST(FaceCache, FailuresKeepNothingAndRecover)
{
    Counted cache;
    const auto set = box();
    View flat;
    flat.toEye = glm::dmat4(0.0);
    EXPECT_EQ(cache.faces(1, set, BOXES, flat, SamplingParameters()).status.code,
              ErrorCode::SINGULAR_MATRIX);
    EXPECT_TRUE(cache.faces(1, set, BOXES, turned(0.0), SamplingParameters()).ok());
}

TEST(FaceCache, HeldFacesAreNeverOverwritten)
{
    Counted cache;
    const auto set = box();
    std::vector<FaceCache::FacesPtr> held;
    std::vector<std::vector<float>> copies;
    for (int i = 0; i < 5; ++i) {
        held.push_back(*cache.faces(1, set, BOXES, turned(0.1 * i), SamplingParameters()));
        copies.push_back(held.back()->faces.vertices);
    }
    for (std::size_t i = 0; i < held.size(); ++i)
        EXPECT_EQ(held[i]->faces.vertices, copies[i]);
}

TEST(FaceCache, ManyThreadsAndViews)
{
    Counted cache;
    const auto set = box();
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 50; ++i) {
                const auto f =
                    cache.faces(t % 2, set, BOXES, turned(0.001 * (i / 10)), SamplingParameters());
                ASSERT_TRUE(f.ok());
                ASSERT_GT((*f)->faces.faceCount(), 0u);
            }
        });
    for (std::thread& t : threads)
        t.join();
    EXPECT_EQ(cache.polygonizations() + cache.reuses(), 200u);
    EXPECT_GE(cache.polygonizations(), 10u); // five directions, two views
}

} // namespace FaceCacheTest
