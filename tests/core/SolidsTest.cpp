#include "osgVolumizer/core/geometry/Solids.h"
#include "TestGeometry.h"
#include "osgVolumizer/core/geometry/TetraMesh.h"

#include "../support/OuterFaces.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numeric>

namespace SolidsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

constexpr double PI = 3.14159265358979323846;

/// All tetrahedra positive, every face shared by two or on the outside, outside closed.
void expectMesh(const TetraSet& set)
{
    ASSERT_TRUE(set.validate().ok());
    ASSERT_GT(set.tetraCount(), 0u);
    for (std::size_t t = 0; t < set.tetraCount(); ++t)
        ASSERT_GT(orientation(set, t), 0.0) << t;
    const Adjacency adjacency = findAdjacency(set);
    EXPECT_TRUE(adjacency.nonManifold.empty());
    glm::dvec3 sum(0.0);
    double signedVolume = 0.0;
    for (const auto& f : osgVolumizer::support::outerFaces(set)) {
        const glm::dvec3 a = set.vertices.position(f[0]), b = set.vertices.position(f[1]),
                         c = set.vertices.position(f[2]);
        sum += glm::cross(b - a, c - a);
        signedVolume += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    // The surface is closed and bounds exactly what the tetrahedra fill: no cracks, no overlaps.
    EXPECT_NEAR(glm::length(sum), 0.0, 1e-9);
    EXPECT_NEAR(signedVolume, volume(set), 1e-9 * volume(set));
}

void expectSecondOrder(const std::function<Result<TetraSet>(int)>& make, double exact)
{
    double error[3];
    for (int i = 0; i < 3; ++i) {
        const Result<TetraSet> set = make(8 << i);
        ASSERT_TRUE(set.ok()) << set.status.text;
        expectMesh(*set);
        error[i] = std::abs(volume(*set) - exact) / exact;
    }
    EXPECT_LT(error[2], 0.02);
    EXPECT_GT(std::log2(error[0] / error[1]), 1.7);
    EXPECT_GT(std::log2(error[1] / error[2]), 1.85);
    EXPECT_LT(std::log2(error[1] / error[2]), 2.2);
}

VertexArray vertexArray(const std::vector<glm::dvec3>& points)
{
    VertexArray v;
    v.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        v.setPosition(i, points[i]);
    return v;
}

/// Turns inverted tetrahedra round; returns how many.
std::size_t turnInverted(TetraSet& set)
{
    std::size_t turned = 0;
    for (std::size_t t = 0; t < set.tetraCount(); ++t)
        if (orientation(set, t) < 0.0) {
            std::swap(set.indices[4 * t], set.indices[4 * t + 1]);
            ++turned;
        }
    return turned;
}

std::vector<TetraSet::Index> counting(std::size_t n)
{
    std::vector<TetraSet::Index> r(n);
    std::iota(r.begin(), r.end(), 0u);
    return r;
}

} // namespace

TEST(Solids, BoxInFiveTwentyFourAndOne)
{
    const Box3d box{{1, 2, 3}, {3, 5, 10}};
    for (const auto how : {BoxTessellation::FIVE, BoxTessellation::TWENTY_FOUR}) {
        const TetraSet set = tessellateBox(box, how);
        expectMesh(set);
        EXPECT_NEAR(volume(set), 42.0, 1e-12);
        EXPECT_EQ(set.tetraCount(), how == BoxTessellation::FIVE ? 5u : 24u);
    }
    const TetraSet one = tessellateBox(box, BoxTessellation::ENCLOSING);
    ASSERT_EQ(one.tetraCount(), 1u);
    expectMesh(one);
    const PointLocator locator(one);
    for (int i = 0; i < 8; ++i)
        EXPECT_TRUE(locator.locate(box.corner(i))) << i;
    EXPECT_NEAR(volume(one), 4.5 * 42.0, 1e-11);
}

TEST(Solids, RoundOnesConvergeAtSecondOrder)
{
    const glm::dvec3 c(1.0, -2.0, 0.5);
    expectSecondOrder(
        [&](int n) {
            return Cone{c, c + glm::dvec3(1, 2, 2), 0.7, n}.tessellate();
        },
        PI * 0.49);
    expectSecondOrder(
        [&](int n) {
            return Cylinder{c, c + glm::dvec3(2, -1, 2), 0.7, n, 3}.tessellate();
        },
        PI * 0.49 * 3.0);
    expectSecondOrder(
        [&](int n) {
            return Sphere{c, 1.5, 2 * n, n}.tessellate();
        },
        4.0 / 3.0 * PI * 3.375);
    expectSecondOrder(
        [&](int n) {
            return GeodesicSphere{c, 1.5, n / 4}.tessellate();
        },
        4.0 / 3.0 * PI * 3.375);
}

TEST(Solids, ComplementsConvergeAtSecondOrder)
{
    const Box3d box{{-2, -3, -4}, {3, 4, 5}};
    const glm::dvec3 c(0.5, 0.25, 1.0);
    expectSecondOrder(
        [&](int n) {
            return BoxMinusSphere{box, c, 1.9, n}.tessellate();
        },
        315.0 - 4.0 / 3.0 * PI * 1.9 * 1.9 * 1.9);
    for (int axis = 0; axis < 3; ++axis)
        expectSecondOrder(
            [&](int n) { return BoxMinusCylinder{box, c, axis, 1.5, n, 2}.tessellate(); },
            315.0 - PI * 2.25 * box.size()[axis]);
    EXPECT_EQ((BoxMinusSphere{box, c, 2.6, 4}.tessellate().status.code), ErrorCode::VALUE_INVALID);
    EXPECT_EQ((BoxMinusCylinder{box, c, 3, 1.0, 4}.tessellate().status.code),
              ErrorCode::VALUE_INVALID);
}

TEST(Solids, ParametersAreChecked)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ((Sphere{{0, 0, 0}, -1.0, 8, 8}.tessellate().status.code), ErrorCode::VALUE_INVALID);
    EXPECT_EQ((Sphere{{0, nan, 0}, 1.0, 8, 8}.tessellate().status.code), ErrorCode::VALUE_INVALID);
    EXPECT_EQ((Sphere{{0, 0, 0}, 1.0, 2, 8}.tessellate().status.code), ErrorCode::VALUE_INVALID);
    EXPECT_EQ((Sphere{{0, 0, 0}, 1.0, 1 << 20, 1 << 20}.tessellate().status.code),
              ErrorCode::TOO_LARGE);
    EXPECT_EQ((Cone{{0, 0, 0}, {0, 0, 0}, 1.0, 8}.tessellate().status.code),
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ((Cylinder{{0, 0, 0}, {0, 0, 1}, 1.0, 8, 0}.tessellate().status.code),
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ((GeodesicSphere{{0, 0, 0}, 1.0, 0}.tessellate().status.code),
              ErrorCode::VALUE_INVALID);
}

TEST(Cells, EveryKindKeepsItsVolumeWhateverTheNumbering)
{
    // A hexahedron, then pyramid and prism out of its vertices, under random renumberings.
    std::vector<glm::dvec3> ring{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0},
                                 {0, 0, 3}, {2, 0, 3}, {2, 1, 3}, {0, 1, 3}};
    const struct
    {
        CellKind kind;
        std::vector<int> corners;
        double volume;
    } cases[] = {{CellKind::HEXA, {0, 1, 2, 3, 4, 5, 6, 7}, 6.0},
                 {CellKind::PYRAMID, {0, 1, 2, 3, 5}, 2.0},
                 {CellKind::PRISM, {0, 1, 2, 4, 5, 6}, 3.0},
                 {CellKind::TETRA, {0, 1, 2, 5}, 1.0}};
    for (const auto& c : cases)
        for (TetraSet::Index shift = 0; shift < 8; ++shift)
            for (TetraSet::Index factor : {1u, 3u, 5u, 7u}) {
                CellSet set;
                set.kind = c.kind;
                set.vertices.resize(8);
                const auto renumber = [&](int i) {
                    return (TetraSet::Index(i) * factor + shift) % 8;
                };
                for (int i = 0; i < 8; ++i)
                    set.vertices.setPosition(renumber(i), ring[std::size_t(i)]);
                for (const int i : c.corners)
                    set.indices.push_back(renumber(i));
                const Result<TetraSet> t = set.tessellate();
                ASSERT_TRUE(t.ok());
                expectMesh(*t);
                EXPECT_NEAR(volume(*t), c.volume, 1e-12);
            }
}

TEST(Cells, NeighboursOfDifferentKindsShareDiagonals)
{
    // 3 x 3 x 3 hexahedra, the middle one as six pyramids about its centre.
    VertexArray vertices;
    vertices.resize(65);
    for (int i = 0; i < 64; ++i)
        vertices.setPosition(std::size_t(i), glm::dvec3(i % 4, i / 4 % 4, i / 16));
    vertices.setPosition(64, glm::dvec3(1.5));
    const auto at = [](int x, int y, int z) { return TetraSet::Index(x + 4 * y + 16 * z); };
    CellSet hexas, pyramids;
    hexas.kind = CellKind::HEXA;
    pyramids.kind = CellKind::PYRAMID;
    hexas.vertices = pyramids.vertices = vertices;
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x) {
                const TetraSet::Index c[8] = {at(x, y, z),
                                              at(x + 1, y, z),
                                              at(x + 1, y + 1, z),
                                              at(x, y + 1, z),
                                              at(x, y, z + 1),
                                              at(x + 1, y, z + 1),
                                              at(x + 1, y + 1, z + 1),
                                              at(x, y + 1, z + 1)};
                if (x != 1 || y != 1 || z != 1) {
                    hexas.indices.insert(hexas.indices.end(), c, c + 8);
                    continue;
                }
                for (const auto& q : {std::array<int, 4>{0, 1, 2, 3},
                                      {4, 7, 6, 5},
                                      {0, 4, 5, 1},
                                      {1, 5, 6, 2},
                                      {2, 6, 7, 3},
                                      {3, 7, 4, 0}}) {
                    for (const int i : q)
                        pyramids.indices.push_back(c[i]);
                    pyramids.indices.push_back(64);
                }
            }
    TetraSet all = *hexas.tessellate();
    const TetraSet inner = *pyramids.tessellate();
    all.indices.insert(all.indices.end(), inner.indices.begin(), inner.indices.end());
    expectMesh(all);
    EXPECT_NEAR(volume(all), 27.0, 1e-12);
}

TEST(Cells, Strips)
{
    // Rings of four up the z axis: hexahedra, and prisms on three of the four.
    std::vector<glm::dvec3> rings, triangles, pairs;
    for (int z = 0; z < 4; ++z) {
        for (const glm::dvec3& p : {glm::dvec3(0, 0, z), {1, 0, z}, {1, 1, z}, {0, 1, z}})
            rings.push_back(p);
        for (const glm::dvec3& p : {glm::dvec3(0, 0, z), {1, 0, z}, {0, 1, z}})
            triangles.push_back(p);
    }
    const auto strip = [&](StripKind kind, const std::vector<glm::dvec3>& p) {
        const Result<CellSet> cells = makeStrip(kind, vertexArray(p), counting(p.size()));
        EXPECT_TRUE(cells.ok()) << cells.status.text;
        const Result<TetraSet> set = cells->tessellate();
        EXPECT_TRUE(set.ok());
        return *set;
    };
    const TetraSet hexas = strip(StripKind::HEXA, rings);
    expectMesh(hexas);
    EXPECT_NEAR(volume(hexas), 3.0, 1e-12);
    const TetraSet bases = strip(StripKind::PRISM_BASE, triangles);
    expectMesh(bases);
    EXPECT_NEAR(volume(bases), 1.5, 1e-12);
    // A zigzag of pillars (bottom, top).
    for (int i = 0; i < 5; ++i)
        for (int z = 0; z < 2; ++z)
            pairs.push_back(glm::dvec3(i * 0.5, i % 2, z));
    TetraSet faces = strip(StripKind::PRISM_FACE, pairs);
    EXPECT_EQ(turnInverted(faces), 6u); // every other prism of a strip is turned round
    expectMesh(faces);
    EXPECT_NEAR(volume(faces), 1.5, 1e-12);
    TetraSet edges = strip(StripKind::PRISM_EDGE, pairs);
    turnInverted(edges);
    EXPECT_EQ(edges.tetraCount(), 6u);
    EXPECT_NEAR(volume(edges), 1.0, 1e-12);
    // Pyramids over a quad strip.
    std::vector<glm::dvec3> pyramids{{1.5, 0.5, 2}};
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 2; ++y)
            pyramids.push_back(glm::dvec3(x, y, 0));
    TetraSet fan = strip(StripKind::PYRAMID, pyramids);
    turnInverted(fan);
    expectMesh(fan);
    EXPECT_NEAR(volume(fan), 2.0, 1e-12);
    // Tetrahedra.
    std::vector<glm::dvec3> helix;
    for (int i = 0; i < 8; ++i)
        helix.push_back({std::cos(i * 2.3), std::sin(i * 2.3), 0.33 * i});
    TetraSet chain = strip(StripKind::TETRA_FACE, helix);
    EXPECT_EQ(chain.tetraCount(), 5u);
    EXPECT_EQ(osgVolumizer::support::outerFaces(chain).size(), 12u); // four inner faces
    EXPECT_EQ(strip(StripKind::TETRA_EDGE, helix).tetraCount(), 3u);
    EXPECT_EQ(makeStrip(StripKind::HEXA, vertexArray(rings), counting(13)).status.code,
              ErrorCode::SIZE_MISMATCH);
}

TEST(Cells, BadIndicesAreNamed)
{
    CellSet set;
    set.kind = CellKind::PRISM;
    set.vertices.resize(6);
    set.indices = {0, 1, 2, 3, 9, 5};
    EXPECT_EQ(set.tessellate().status.code, ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(set.tessellate().status.index, 4);
    set.indices.pop_back();
    EXPECT_EQ(set.tessellate().status.code, ErrorCode::SIZE_MISMATCH);
}

} // namespace SolidsTest
