// Cells of different kinds agree on the tetrahedra at their common faces, whatever their numbers.

#include "osgVolumizer/core/geometry/CellSplitting.h"
#include "osgVolumizer/core/geometry/TetraMesh.h"

#include "../support/OuterFaces.h"

#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace CellSplittingTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

constexpr int N = 4; ///< cubes along an axis

struct Cell
{
    CellKind kind;
    std::vector<TetraSet::Index> corners;
};

struct Mesh
{
    std::vector<glm::dvec3> points;
    std::vector<Cell> cells;
    double volume = 0.0;
};

/// N^3 cubes: columns along z of hexahedra, or of pairs of prisms; some hexahedra are six pyramids.
/// A tetrahedron stands on each prism at the upper end. Inner vertices of columns without prisms
/// are moved, so that quadrilaterals are not flat.
Mesh mixedMesh(std::mt19937& random)
{
    Mesh mesh;
    const int m = N + 1;
    const auto at = [m](int x, int y, int z) {
        return static_cast<TetraSet::Index>((z * m + y) * m + x);
    };
    std::uniform_real_distribution<double> u(-0.15, 0.15);
    for (int z = 0; z < m; ++z)
        for (int y = 0; y < m; ++y)
            for (int x = 0; x < m; ++x) {
                glm::dvec3 p(x, y, z);
                for (int a = 0; a < 3; ++a)
                    if (p[a] > 0 && p[a] < N) p[a] += u(random);
                mesh.points.push_back(p);
            }
    mesh.volume = N * N * N;
    for (int y = 0; y < N; ++y)
        for (int x = 0; x < N; ++x) {
            const bool prisms = random() % 2;
            for (int z = 0; z < N; ++z) {
                TetraSet::Index c[8];
                const int ring[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                for (int i = 0; i < 8; ++i)
                    c[i] = at(x + ring[i % 4][0], y + ring[i % 4][1], z + i / 4);
                if (prisms) {
                    mesh.cells.push_back({CellKind::PRISM, {c[0], c[1], c[2], c[4], c[5], c[6]}});
                    mesh.cells.push_back({CellKind::PRISM, {c[0], c[2], c[3], c[4], c[6], c[7]}});
                    if (z + 1 < N) continue;
                    const glm::dvec3 apex = mesh.points[c[4]] + glm::dvec3(0.6, 0.3, 1.0);
                    const glm::dvec3 a = mesh.points[c[4]], b = mesh.points[c[5]],
                                     d = mesh.points[c[6]];
                    mesh.volume +=
                        std::abs(glm::determinant(glm::dmat3(b - a, d - a, apex - a))) / 6.0;
                    mesh.points.push_back(apex);
                    mesh.cells.push_back(
                        {CellKind::TETRA,
                         {c[4], c[5], c[6], static_cast<TetraSet::Index>(mesh.points.size() - 1)}});
                } else if (random() % 3 == 0) {
                    const auto center = static_cast<TetraSet::Index>(mesh.points.size());
                    mesh.points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
                    const int faces[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                             {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
                    for (const auto& f : faces)
                        mesh.cells.push_back(
                            {CellKind::PYRAMID, {c[f[0]], c[f[1]], c[f[2]], c[f[3]], center}});
                } else {
                    mesh.cells.push_back({CellKind::HEXA, {c, c + 8}});
                }
            }
        }
    return mesh;
}

TetraSet split(const Mesh& mesh, const std::vector<TetraSet::Index>& number)
{
    TetraSet set;
    set.vertices.resize(mesh.points.size());
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        set.vertices.setPosition(number[i], mesh.points[i]);
    for (const Cell& cell : mesh.cells) {
        std::vector<TetraSet::Index> corners;
        for (const TetraSet::Index i : cell.corners)
            corners.push_back(number[i]);
        splitCell(cell.kind, corners.data(), set.indices);
    }
    return set;
}

} // namespace

TEST(CellSplitting, NeighboursOfAnyKindAgreeUnderAnyNumbering)
{
    std::mt19937 random(4);
    for (int round = 0; round < 60; ++round) {
        const Mesh mesh = mixedMesh(random);
        std::vector<TetraSet::Index> number(mesh.points.size());
        std::iota(number.begin(), number.end(), 0u);
        if (round > 0) std::shuffle(number.begin(), number.end(), random);
        const TetraSet set = split(mesh, number);
        ASSERT_TRUE(set.validate().ok());
        EXPECT_NEAR(volume(set), mesh.volume, 1e-12 * mesh.volume);
        const Adjacency adjacency = findAdjacency(set);
        EXPECT_TRUE(adjacency.nonManifold.empty());
        // Nothing open inside: the boundary is that of the cube with tetrahedra on it, so the six
        // sides of the cube are all there is below z = N.
        std::size_t below = 0;
        for (const auto& face : osgVolumizer::support::outerFaces(set)) {
            glm::dvec3 low(1e9), high(-1e9);
            for (const TetraSet::Index i : face) {
                low = glm::min(low, set.vertices.position(i));
                high = glm::max(high, set.vertices.position(i));
            }
            if (high.z > N) continue;
            ++below;
            bool onHull = false;
            for (int a = 0; a < 3; ++a)
                onHull = onHull || (low[a] == high[a] && (low[a] == 0.0 || low[a] == N));
            EXPECT_TRUE(onHull);
        }
        EXPECT_GE(below, std::size_t(5 * N * N * 2));
    }
}

TEST(CellSplitting, OrientationIsThatOfTheCell)
{
    // Whichever vertex is the lowest, all tetrahedra of a cell have the sign of the cell.
    const std::vector<glm::dvec3> corners[4] = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.4, 0.5, 1}},
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
    const double volumes[4] = {1.0 / 6.0, 1.0 / 3.0, 0.5, 1.0};
    std::mt19937 random(5);
    for (int kind = 0; kind < 4; ++kind)
        for (int round = 0; round < 50; ++round) {
            const auto size = static_cast<std::size_t>(cellSize(static_cast<CellKind>(kind)));
            ASSERT_EQ(size, corners[kind].size());
            std::vector<TetraSet::Index> number(size);
            std::iota(number.begin(), number.end(), 0u);
            std::shuffle(number.begin(), number.end(), random);
            TetraSet set;
            set.vertices.resize(size);
            for (std::size_t i = 0; i < size; ++i)
                set.vertices.setPosition(number[i], corners[kind][i]);
            splitCell(static_cast<CellKind>(kind), number.data(), set.indices);
            double sum = 0.0;
            for (std::size_t t = 0; t < set.tetraCount(); ++t) {
                EXPECT_GT(orientation(set, t), 0.0);
                sum += orientation(set, t) / 6.0;
            }
            EXPECT_NEAR(sum, volumes[kind], 1e-15);
        }
}

} // namespace CellSplittingTest
