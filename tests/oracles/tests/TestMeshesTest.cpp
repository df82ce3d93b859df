#include <oracles/MeshOracle.h>
#include <oracles/TestMeshes.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <map>
#include <numeric>

namespace TestMeshesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::oracle;

namespace {

double volume(const TetraMesh& mesh)
{
    double sum = 0.0;
    for (const TetraMesh::Cell& cell : mesh.cells)
        sum += mesh.signedVolume(cell);
    return sum;
}

double smallestVolume(const TetraMesh& mesh)
{
    double smallest = mesh.signedVolume(mesh.cells.front());
    for (const TetraMesh::Cell& cell : mesh.cells)
        smallest = std::min(smallest, mesh.signedVolume(cell));
    return smallest;
}

using Face = std::array<std::uint32_t, 3>;

std::map<Face, std::vector<std::uint32_t>> cellsOfFaces(const TetraMesh& mesh)
{
    std::map<Face, std::vector<std::uint32_t>> cells;
    for (std::uint32_t c = 0; c < mesh.cells.size(); ++c)
        for (std::size_t i = 0; i < 4; ++i) {
            const TetraMesh::Cell& cell = mesh.cells[c];
            Face face{cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]};
            std::sort(face.begin(), face.end());
            cells[face].push_back(c);
        }
    return cells;
}

// No face belongs to more than two cells; returns the area of those that belong to one.
double boundaryArea(const TetraMesh& mesh)
{
    double area = 0.0;
    for (const auto& entry : cellsOfFaces(mesh)) {
        EXPECT_LE(entry.second.size(), 2u);
        const glm::dvec3 a = mesh.points[entry.first[0]];
        if (entry.second.size() == 1)
            area += 0.5 * glm::length(glm::cross(mesh.points[entry.first[1]] - a,
                                                 mesh.points[entry.first[2]] - a));
    }
    return area;
}

// Pieces of cells that are joined by faces.
std::size_t pieces(const TetraMesh& mesh)
{
    std::vector<std::uint32_t> parent(mesh.cells.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t c) {
        while (parent[c] != c)
            c = parent[c];
        return c;
    };
    for (const auto& entry : cellsOfFaces(mesh))
        parent[root(entry.second.front())] = root(entry.second.back());
    std::size_t count = 0;
    for (std::uint32_t c = 0; c < parent.size(); ++c)
        count += parent[c] == c ? 1u : 0u;
    return count;
}

} // namespace

TEST(TestMeshes, LatticesTileTheCube)
{
    for (const HexahedronSplit split : {HexahedronSplit::FIVE, HexahedronSplit::SIX}) {
        const TetraMesh mesh = latticeMesh({3, 4, 5}, split);
        EXPECT_EQ(mesh.cells.size(), split == HexahedronSplit::FIVE ? 300u : 360u);
        EXPECT_EQ(mesh.points.size(), 4u * 5u * 6u);
        EXPECT_GT(smallestVolume(mesh), 0.0);
        EXPECT_NEAR(volume(mesh), 1.0, 1e-13);
        EXPECT_NEAR(boundaryArea(mesh), 6.0, 1e-12); // so all faces inside are shared
        EXPECT_EQ(pieces(mesh), 1u);
    }
}

TEST(TestMeshes, PartsOfTheCubeAreWhatTheySay)
{
    for (const HexahedronSplit split : {HexahedronSplit::FIVE, HexahedronSplit::SIX}) {
        const TetraMesh corner = cornerMesh(4, split);
        EXPECT_NEAR(volume(corner), 0.75, 1e-13);
        EXPECT_NEAR(boundaryArea(corner), 5.5, 1e-12);
        EXPECT_EQ(pieces(corner), 1u);
        const TetraMesh hole = holeMesh(6, split);
        EXPECT_NEAR(volume(hole), 8.0 / 9.0, 1e-13);
        EXPECT_NEAR(boundaryArea(hole), 6.0 - 2.0 / 9.0 + 4.0 / 3.0, 1e-12);
        EXPECT_EQ(pieces(hole), 1u);
        const TetraMesh two = twoPieceMesh(6, split);
        EXPECT_NEAR(volume(two), 2.0 / 3.0, 1e-13);
        EXPECT_EQ(pieces(two), 2u);
        EXPECT_EQ(two.points.size(), 6u * 7u * 7u); // none that is not used
    }
}

TEST(TestMeshes, JitterMovesOnlyWhatIsInside)
{
    const TetraMesh before = latticeMesh(glm::ivec3(6));
    TetraMesh mesh = before;
    jitter(mesh, 0.06, 5);
    const std::vector<bool> boundary = boundaryPoints(before);
    EXPECT_EQ(std::count(boundary.begin(), boundary.end(), false), 5 * 5 * 5);
    for (std::size_t i = 0; i < boundary.size(); ++i)
        EXPECT_EQ(mesh.points[i] == before.points[i], boundary[i]);
    EXPECT_GT(smallestVolume(mesh), 0.0);
    EXPECT_LT(smallestVolume(mesh), 0.7 * smallestVolume(before));
    EXPECT_NEAR(volume(mesh), 1.0, 1e-13);
}

TEST(TestMeshes, FlattenMakesSlivers)
{
    TetraMesh mesh = latticeMesh(glm::ivec3(6), HexahedronSplit::SIX);
    const double whole = smallestVolume(mesh);
    const std::size_t made = flatten(mesh, 0.05, 1e-6, 5);
    EXPECT_GT(made, 10u);
    std::size_t flat = 0;
    for (const TetraMesh::Cell& cell : mesh.cells)
        flat += mesh.signedVolume(cell) < 1.1e-6 * whole ? 1u : 0u;
    EXPECT_GE(flat, made); // more where two lie in one plane
    EXPECT_GT(smallestVolume(mesh), 0.0);
    EXPECT_NEAR(volume(mesh), 1.0, 1e-13);
}

TEST(TestMeshes, BarsHideEachOtherInACircle)
{
    TetraMesh bars = cyclicBars(4);
    bars.scalars.assign(bars.points.size(), 0.0);
    EXPECT_EQ(pieces(bars), 3u);
    const MeshOracle oracle(bars, Table(), 1.0);
    const std::size_t cellsOfBar = bars.cells.size() / 3;
    std::map<std::size_t, std::size_t> hides;
    for (int i = 0; i < 3; ++i) {
        const double angle = glm::radians(90.0 + 120.0 * i);
        const glm::dvec3 origin(0.8 * std::cos(angle), 0.8 * std::sin(angle), 5.0);
        const auto segments = oracle.segments(origin, {0.0, 0.0, -1.0}, 0.0, 10.0);
        ASSERT_FALSE(segments.empty());
        // Two bars, one clearly behind the other.
        const std::size_t front = segments.front().cell / cellsOfBar;
        const std::size_t back = segments.back().cell / cellsOfBar;
        EXPECT_NE(front, back);
        for (std::size_t s = 0; s + 1 < segments.size(); ++s) {
            const bool same = segments[s].cell / cellsOfBar == segments[s + 1].cell / cellsOfBar;
            const double gap = segments[s + 1].enter - segments[s].leave;
            EXPECT_EQ(same, gap < 1e-12);
            EXPECT_EQ(same, gap < 0.1);
        }
        hides[front] = back;
    }
    ASSERT_EQ(hides.size(), 3u);
    EXPECT_NE(hides[hides[0]], 0u); // not two that hide each other: a circle of three
    EXPECT_EQ(hides[hides[hides[0]]], 0u);
}

TEST(TestMeshes, FieldsAreSampledInFloat)
{
    TetraMesh mesh = latticeMesh(glm::ivec3(3));
    transform(mesh, glm::scale(glm::dmat4(1.0), glm::dvec3(3.0)));
    const RampField field({1.0, 2.0, 4.0}, 0.1);
    sampleField(mesh, field);
    ASSERT_EQ(mesh.scalars.size(), 64u);
    EXPECT_EQ(mesh.scalars[63], double(float(21.1)));
    sampleField(mesh, field, true);
    ASSERT_EQ(mesh.scalars.size(), 135u);
    EXPECT_TRUE(mesh.scalarsPerCell);
    EXPECT_EQ(mesh.scalars[0], double(float(0.1 + 0.25 * 7.0))); // corners 0, x, y and z
    const core::TetraSet set = tetraSet(mesh);
    EXPECT_TRUE(set.validate().ok());
    EXPECT_EQ(set.tetraCount(), 135u);
    EXPECT_EQ(set.vertices.position(63), mesh.points[63]);
}

} // namespace TestMeshesTest
