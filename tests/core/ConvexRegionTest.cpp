#include "osgVolumizer/core/geometry/ConvexRegion.h"
#include "TestGeometry.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>

namespace ConvexRegionTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

TEST(ConvexPolytope, BoxHasItsVolumeAndOutwardFaces)
{
    ConvexPolytope p;
    p.setBox({{1, 2, 3}, {4, 6, 9}});
    EXPECT_DOUBLE_EQ(p.volume(), 72.0);
    for (std::size_t f = 0; f < 6; ++f) {
        const double outwards = glm::dot(p.faceNormal(f), p.vertices[p.indices[p.faceOffsets[f]]] -
                                                              glm::dvec3(2.5, 4.0, 6.0));
        EXPECT_GT(outwards, 0.0);
        EXPECT_EQ(p.faceTags[f], static_cast<int>(f));
    }
    p.setBox({{1, 2, 3}, {4, 2, 9}});
    EXPECT_TRUE(p.empty());
}

TEST(ConvexPolytope, TwoSidesOfRandomPlanesAddUp)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    ConvexPolytope whole, a, b;
    for (int round = 0; round < 200; ++round) {
        whole.setBox({glm::dvec3(-1.0), glm::dvec3(1.0)});
        for (int i = 0; i < 12 && !whole.empty(); ++i) {
            Plane plane{glm::normalize(glm::dvec3(u(random), u(random), u(random))),
                        0.7 * u(random)};
            // Planes through vertices, edges and faces as well.
            if (i % 3 == 1) plane.offset = -glm::dot(plane.normal, whole.vertices[0]);
            if (i % 3 == 2) plane.normal = {0, 0, 1};
            a.assign(whole);
            b.assign(whole);
            a.clip(plane, 6 + i);
            b.clip({-plane.normal, -plane.offset}, 6 + i);
            ASSERT_NEAR(a.volume() + b.volume(), whole.volume(), 1e-12);
            whole.assign(a.volume() > b.volume() ? a : b);
            // Closed: the face normals add up to nothing, and Euler's formula holds.
            glm::dvec3 sum(0.0);
            for (std::size_t f = 0; f < whole.faceCount(); ++f)
                sum += whole.faceNormal(f);
            ASSERT_NEAR(glm::length(sum), 0.0, 1e-12);
            ASSERT_EQ(whole.vertices.size() - whole.indices.size() / 2 + whole.faceCount(), 2u);
        }
    }
}

TEST(ConvexRegion, BoxesInAnyTessellationHaveSixPlanes)
{
    const glm::dvec3 low(1.0, 2.0, 3.0), high(9.0, 5.0, 4.0);
    const std::optional<ConvexRegion> r = convexRegion(makeBox(low, high));
    ASSERT_TRUE(r);
    EXPECT_EQ(r->planes.size(), 6u);
    EXPECT_TRUE(r->contains({5.0, 3.0, 3.5}));
    EXPECT_FALSE(r->contains({0.9, 3.0, 3.5}));
    EXPECT_EQ(convexRegion(makeGrid(3, 4.0))->planes.size(), 6u);
    TetraSet moved = makeBox(low, high);
    for (std::size_t i = 0; i < 8; ++i)
        moved.vertices.setPosition(i, 1e-6 * moved.vertices.position(i) + glm::dvec3(6.4e6));
    TetraSet inverted = makeBox(low, high);
    for (std::size_t i = 0; i < inverted.indices.size(); i += 8)
        std::swap(inverted.indices[i], inverted.indices[i + 1]);
    EXPECT_TRUE(convexRegion(inverted));
}

TEST(ConvexRegion, HolesOverlapsAndNotchesAreNone)
{
    TetraSet grid = makeGrid(3, 3.0);
    TetraSet notch = grid;
    notch.indices.erase(notch.indices.begin(), notch.indices.begin() + 4);
    EXPECT_FALSE(convexRegion(notch));
    TetraSet hole = grid;
    const auto middle = hole.indices.begin() + 13 * 20; // the cell in the middle
    hole.indices.erase(middle, middle + 20);
    EXPECT_FALSE(convexRegion(hole));
    TetraSet twice = grid;
    twice.indices.insert(twice.indices.end(), grid.indices.begin(), grid.indices.end());
    EXPECT_FALSE(convexRegion(twice));
    // The same box cut the other way: no face matches, all lie on the hull, the volume is double.
    TetraSet both = makeBox(glm::dvec3(0.0), glm::dvec3(1.0));
    for (const TetraSet::Index i : makeBox(glm::dvec3(0.0), glm::dvec3(1.0)).indices)
        both.indices.push_back(i ^ 1u);
    EXPECT_FALSE(convexRegion(both));
    EXPECT_FALSE(convexRegion(TetraSet()));
    TetraSet flat = makeBox(glm::dvec3(0.0), glm::dvec3(1.0, 1.0, 0.0));
    EXPECT_FALSE(convexRegion(flat));
}

} // namespace ConvexRegionTest
