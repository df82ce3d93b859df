// No allocation per frame once the largest was seen: counted, by replacing operator new.

// Operators new and delete are replaced as a pair here; GCC 12 sees one of them inlined without the
// other.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

#include "TestGeometry.h"
#include "osgVolumizer/core/geometry/ConvexRegion.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> allocations{0};
}

void* operator new(std::size_t size)
{
    ++allocations;
    if (void* p = std::malloc(size ? size : 1)) return p;
    throw std::bad_alloc();
}
// What std::stable_sort takes, and gives back to operator delete.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
    ++allocations;
    return std::malloc(size ? size : 1);
}
void operator delete(void* p) noexcept
{
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept
{
    std::free(p);
}

namespace AllocationTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

TEST(Allocation, NoneAfterTheFirstTurn)
{
    Polygonizer polygonizer;
    ASSERT_TRUE(polygonizer.setTetraSet(std::make_shared<TetraSet>(makeGrid(6, 6.0))).ok());
    std::vector<Box3d> boxes;
    for (int i = 0; i < 8; ++i)
        boxes.push_back({{i & 1 ? 2.3 : 0.0, i & 2 ? 3.0 : 0.0, i & 4 ? 1.1 : 0.0},
                         {i & 1 ? 6.0 : 2.3, i & 2 ? 6.0 : 3.0, i & 4 ? 6.0 : 1.1}});
    ASSERT_TRUE(polygonizer.setClipBoxes(boxes).ok());
    PolygonizedFaces out;
    const auto turn = [&] {
        for (int i = 0; i < 40; ++i)
            for (const auto mode : {SamplingMode::VIEWPORT_ALIGNED, SamplingMode::AXIS_ALIGNED,
                                    SamplingMode::SPHERICAL}) {
                SamplingParameters p;
                p.mode = mode;
                p.cullToView = i % 2 == 0;
                p.periodVoxel = glm::dvec3(0.4);
                p.curvedTolerance = 0.5;
                const View view = viewAlong({std::cos(0.16 * i), std::sin(0.16 * i), 0.3});
                ASSERT_TRUE(polygonizer.polygonize(view, p, out).ok());
            }
    };
    turn();
    const std::size_t before = allocations;
    turn();
    EXPECT_EQ(allocations - before, 0u);
}

TEST(Allocation, NoneInPolytopeClipping)
{
    const ConvexRegion region = *convexRegion(makeGrid(2, 4.0));
    ConvexPolytope polytope;
    const auto frame = [&] {
        for (int i = 0; i < 50; ++i) {
            polytope.setBox({{0.5, 0.1, -1}, {5, 3, 3}});
            clipPolytope(polytope, region, 6);
            const double angle = 0.1 * i;
            const glm::dvec3 n(std::cos(angle), std::sin(angle), 0.7);
            polytope.clip({n, -2.0}, 20);
            polytope.clip({-n, 2.5}, 21);
        }
    };
    for (int i = 0; i < 3; ++i)
        frame(); // buffers change places, so each has to grow
    const std::size_t before = allocations;
    frame();
    EXPECT_EQ(allocations - before, 0u);
}

} // namespace AllocationTest
