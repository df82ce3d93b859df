#include "osgVolumizer/core/geometry/Lattice.h"
#include "TestGeometry.h"
#include "osgVolumizer/core/geometry/TetraMesh.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace LatticeTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

Lattice lattice(const glm::ivec3& points)
{
    Lattice made;
    made.box = {{1, 2, 3}, {5, 8, 6}};
    made.points = points;
    return made;
}

const glm::dvec3 ORIGIN(0.5, 0, 1), SPACING(0.5, 1, 2);

} // namespace

TEST(Lattices, AtRestAreTheBoxToTheBit)
{
    for (const bool zeros : {false, true}) {
        Lattice rest = lattice({3, 4, 2});
        if (zeros) rest.offsets.assign(rest.count(), glm::dvec3(0.0));
        const Result<TetraSet> set = rest.tessellate({4, 3, 5}, ORIGIN, SPACING);
        ASSERT_TRUE(set.ok()) << set.status.text;
        EXPECT_EQ(set->vertices.size(), std::size_t(5 * 4 * 6));
        for (std::size_t i = 0; i < set->vertices.size(); ++i)
            EXPECT_EQ(set->vertices.voxelCoordinate(i),
                      (set->vertices.position(i) - ORIGIN) / SPACING);
        EXPECT_EQ(set->bounds(), rest.box);
        EXPECT_NEAR(volume(*set), 4 * 6 * 3, 1e-9);
    }
}

// A point moves all by its Bernstein polynomial: here 6 u^2 (1-u)^2 of five, 2 u (1-u) of three,
// and u of two.
TEST(Lattices, BendByBernsteinPolynomials)
{
    Lattice bent = lattice({5, 3, 2});
    bent.offsets.assign(bent.count(), glm::dvec3(0.0));
    const std::size_t moved = (1 * 3 + 1) * 5 + 2;
    EXPECT_EQ(bent.restPoint(moved), glm::dvec3(3, 5, 6));
    bent.offsets[moved] = {0.3, -0.2, 0.1};
    const Result<TetraSet> set = bent.tessellate({6, 5, 4}, ORIGIN, SPACING);
    ASSERT_TRUE(set.ok());
    for (std::size_t i = 0; i < set->vertices.size(); ++i) {
        const glm::dvec3 rest = set->vertices.voxelCoordinate(i) * SPACING + ORIGIN;
        const glm::dvec3 u = (rest - bent.box.min) / bent.box.size();
        const double weight = 6 * u.x * u.x * (1 - u.x) * (1 - u.x) * 2 * u.y * (1 - u.y) * u.z;
        EXPECT_LT(glm::length(set->vertices.position(i) - rest - weight * bent.offsets[moved]),
                  1e-13);
    }
}

// Offsets of an affine map make that map, whatever the number of points.
TEST(Lattices, ReproduceAffineMaps)
{
    const auto affine = [](const glm::dvec3& p) {
        return glm::dvec3(p.x + 0.3 * p.y, 2.0 * p.y - 0.1 * p.z, p.z + 0.2 * p.x + 4.0);
    };
    Lattice bent = lattice({4, 3, 6});
    for (std::size_t i = 0; i < bent.count(); ++i)
        bent.offsets.push_back(affine(bent.restPoint(i)) - bent.restPoint(i));
    const Result<TetraSet> set = bent.tessellate({3, 2, 4}, ORIGIN, SPACING);
    ASSERT_TRUE(set.ok()) << set.status.text;
    for (std::size_t i = 0; i < set->vertices.size(); ++i) {
        const glm::dvec3 rest = set->vertices.voxelCoordinate(i) * SPACING + ORIGIN;
        EXPECT_LT(glm::length(set->vertices.position(i) - affine(rest)), 1e-12);
    }
}

TEST(Lattices, RefuseToFoldOver)
{
    Lattice bent = lattice({3, 3, 3});
    bent.offsets.assign(bent.count(), glm::dvec3(0.0));
    bent.offsets[0] = {9, 0, 0}; // a corner beyond the opposite face
    Result<TetraSet> set = bent.tessellate({4, 4, 4}, ORIGIN, SPACING);
    EXPECT_EQ(set.status.code, ErrorCode::VALUE_INVALID);
    EXPECT_NE(set.status.text.find("folds over"), std::string::npos) << set.status.text;
    EXPECT_GE(set.status.index, 0);
    // All onto a plane, and turned inside out as a whole.
    for (const double scale : {0.0, -1.0}) {
        for (std::size_t i = 0; i < bent.count(); ++i)
            bent.offsets[i] = {0, 0, (scale - 1.0) * bent.restPoint(i).z};
        EXPECT_EQ(bent.tessellate({4, 4, 4}, ORIGIN, SPACING).status.code,
                  ErrorCode::VALUE_INVALID);
    }
    // Just not.
    for (std::size_t i = 0; i < bent.count(); ++i)
        bent.offsets[i] = {0, 0, (0.01 - 1.0) * bent.restPoint(i).z};
    EXPECT_TRUE(bent.tessellate({4, 4, 4}, ORIGIN, SPACING).ok());
}

TEST(Lattices, RefuseWhatIsNone)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto code = [](const Lattice& bad, const glm::ivec3& cells = {2, 2, 2}) {
        return bad.tessellate(cells, ORIGIN, SPACING).status.code;
    };
    EXPECT_EQ(code(lattice({1, 3, 3})), ErrorCode::VALUE_INVALID);
    EXPECT_EQ(code(lattice({3, 17, 3})), ErrorCode::VALUE_INVALID);
    EXPECT_EQ(code(lattice({3, 3, 3}), {0, 1, 1}), ErrorCode::VALUE_INVALID);
    EXPECT_EQ(code(lattice({3, 3, 3}), {1, 1, 65}), ErrorCode::VALUE_INVALID);
    Lattice bad = lattice({3, 3, 3});
    bad.box.max.y = bad.box.min.y;
    EXPECT_EQ(code(bad), ErrorCode::VALUE_INVALID);
    bad.box.max.y = nan;
    EXPECT_EQ(code(bad), ErrorCode::VALUE_INVALID);
    bad = lattice({3, 3, 3});
    bad.offsets.assign(26, glm::dvec3(0.0));
    EXPECT_EQ(code(bad), ErrorCode::SIZE_MISMATCH);
    bad.offsets.assign(27, glm::dvec3(0.0));
    bad.offsets[7].z = nan;
    EXPECT_EQ(code(bad), ErrorCode::VALUE_INVALID);
    EXPECT_EQ(bad.validate().index, 7);
    bad.offsets[7].z = 1e31;
    EXPECT_EQ(code(bad), ErrorCode::VALUE_INVALID);
}

} // namespace LatticeTest
