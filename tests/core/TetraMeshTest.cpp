#include "osgVolumizer/core/geometry/TetraMesh.h"
#include "TestGeometry.h"

#include "../support/OuterFaces.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace TetraMeshTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

TEST(TetraSet, ValidateNamesTheFirstOffender)
{
    TetraSet set = makeBox(glm::dvec3(0.0), glm::dvec3(1.0));
    EXPECT_TRUE(set.validate().ok());
    EXPECT_TRUE(TetraSet().validate().ok());
    TetraSet bad = set;
    bad.indices[7] = 8;
    EXPECT_EQ(bad.validate().code, ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(bad.validate().index, 7);
    bad = set;
    bad.vertices.setPosition(3, {0.0, std::numeric_limits<double>::infinity(), 0.0});
    EXPECT_EQ(bad.validate().code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(bad.validate().index, 3);
    bad = set;
    bad.indices.pop_back();
    EXPECT_EQ(bad.validate().code, ErrorCode::SIZE_MISMATCH);
    bad = set;
    bad.vertices.values().pop_back();
    EXPECT_EQ(bad.validate().code, ErrorCode::SIZE_MISMATCH);
    EXPECT_EQ(TetraSet().bounds().empty(), true);
}

TEST(TetraMesh, AdjacencyBoundaryAndOrientation)
{
    TetraSet grid = makeGrid(3, 3.0);
    EXPECT_NEAR(volume(grid), 27.0, 1e-12);
    std::swap(grid.indices[8], grid.indices[9]);
    std::swap(grid.indices[100], grid.indices[101]);
    const Adjacency a = findAdjacency(grid);
    EXPECT_EQ(osgVolumizer::support::outerFaces(grid).size(), 6u * 9u * 2u);
    for (std::size_t t = 0; t < grid.tetraCount(); ++t)
        for (const std::int32_t n : a.neighbours[t]) {
            if (n == Adjacency::NONE) continue;
            const auto& back = a.neighbours[std::size_t(n)];
            EXPECT_NE(std::find(back.begin(), back.end(), std::int32_t(t)), back.end());
        }
    for (const auto& f : osgVolumizer::support::outerFaces(grid)) {
        const glm::dvec3 p = grid.vertices.position(f[0]), q = grid.vertices.position(f[1]),
                         r = grid.vertices.position(f[2]);
        EXPECT_GT(glm::dot(glm::cross(q - p, r - p), p + q + r - glm::dvec3(4.5)), 0.0);
    }
    // A third tetrahedron on one face.
    TetraSet three;
    three.vertices.resize(6);
    three.indices = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 5};
    EXPECT_EQ(findAdjacency(three).nonManifold, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(TetraMesh, AffineMapOfATetrahedron)
{
    TetraSet set;
    set.vertices = VertexArray(VertexFormat(VertexLayout::T3F_V3F));
    set.vertices.resize(4);
    set.indices = {0, 1, 2, 3};
    const glm::dmat3 linear(2, 0.5, 0, 0, 3, 0.25, 1, 0, -4);
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3 p(i == 1 ? 2.0 : 0.5, i == 2 ? 3.0 : 0.0, i == 3 ? 1.0 : -1.0);
        set.vertices.setPosition(i, p);
        set.vertices.setVoxelCoordinate(i, linear * p + glm::dvec3(5, 6, 7));
    }
    const glm::dvec3 p(0.3, 0.4, 0.5);
    const glm::dvec3 v = glm::dvec3(*positionToVoxel(set, 0) * glm::dvec4(p, 1.0));
    EXPECT_LT(glm::length(v - (linear * p + glm::dvec3(5, 6, 7))), 1e-12);
    EXPECT_EQ(positionToVoxel(set, 1).status.code, ErrorCode::INDEX_OUT_OF_RANGE);
    set.indices = {0, 1, 2, 2};
    EXPECT_EQ(positionToVoxel(set, 0).status.code, ErrorCode::SINGULAR_MATRIX);
}

TEST(TetraMesh, LocatesPointsWithTheirWeights)
{
    const TetraSet grid = makeGrid(6, 3.0);
    const PointLocator locator(grid);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(-0.5, 3.5);
    for (int i = 0; i < 3000; ++i) {
        glm::dvec3 p(u(random), u(random), u(random));
        if (i % 3 == 0) p = glm::round(p * 4.0) / 4.0; // on vertices, edges and faces
        const bool inside = p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x <= 3 && p.y <= 3 && p.z <= 3;
        const auto place = locator.locate(p);
        ASSERT_EQ(place.has_value(), inside) << p.x << " " << p.y << " " << p.z;
        if (!place) continue;
        glm::dvec3 back(0.0);
        for (int k = 0; k < 4; ++k)
            back += place->weights[k] *
                    grid.vertices.position(grid.indices[4 * place->tetrahedron + std::size_t(k)]);
        EXPECT_LT(glm::length(back - p), 1e-12);
    }
    EXPECT_FALSE(PointLocator(TetraSet()).locate(glm::dvec3(0.0)));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(locator.locate({nan, 1.0, 1.0}));
}

} // namespace TetraMeshTest
