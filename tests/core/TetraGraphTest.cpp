// What rays walk through: neighbours, outer faces and the grid over them.
#include <osgVolumizer/core/geometry/TetraGraph.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <set>

namespace TetraGraphTest {

using namespace osgVolumizer::core;

namespace {

using Index = TetraSet::Index;

TetraSet setOf(const std::vector<glm::dvec3>& points, std::vector<Index> indices)
{
    TetraSet set;
    set.vertices.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        set.vertices.setPosition(i, points[i]);
    set.indices = std::move(indices);
    return set;
}

// n^3 cubes, each in six tetrahedra about a diagonal.
TetraSet cubes(int n)
{
    std::vector<glm::dvec3> points;
    for (int z = 0; z <= n; ++z)
        for (int y = 0; y <= n; ++y)
            for (int x = 0; x <= n; ++x)
                points.emplace_back(x, y, z);
    std::vector<Index> indices;
    const auto at = [n](const glm::ivec3& p) {
        return Index(p.x + (n + 1) * (p.y + (n + 1) * p.z));
    };
    for (int c = 0; c < n * n * n; ++c) {
        const glm::ivec3 low(c % n, c / n % n, c / (n * n));
        int axes[3] = {0, 1, 2};
        do {
            glm::ivec3 p = low;
            indices.push_back(at(p));
            for (const int axis : axes) {
                ++p[axis];
                indices.push_back(at(p));
            }
        } while (std::next_permutation(axes, axes + 3));
    }
    return setOf(points, std::move(indices));
}

std::array<Index, 4> sortedVertices(const TetraSet& set, std::uint32_t tetrahedron)
{
    std::array<Index, 4> v;
    std::copy_n(&set.indices[4 * std::size_t(tetrahedron)], 4, v.begin());
    std::sort(v.begin(), v.end());
    return v;
}

} // namespace

TEST(TetraGraph, NeighboursShareTheFaceOppositeAVertex)
{
    const TetraSet set = cubes(3);
    const TetraGraph graph = makeTetraGraph(set);
    ASSERT_EQ(graph.cellCount, 162u);
    std::size_t outer = 0;
    for (std::uint32_t cell = 0; cell < graph.cellCount; ++cell) {
        const auto v = sortedVertices(set, graph.numbers[cell]);
        const std::uint32_t* words = &graph.words[TetraGraph::CELL_WORDS * cell];
        EXPECT_EQ(words[0], v[0] ^ v[1] ^ v[2] ^ v[3]);
        for (std::size_t i = 0; i < 4; ++i) {
            const std::uint32_t other = words[1 + i];
            outer += other == TetraGraph::OUTSIDE;
            if (other == TetraGraph::OUTSIDE) continue;
            const auto w = sortedVertices(set, graph.numbers[other]);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_EQ(std::count(w.begin(), w.end(), v[k]), k == i ? 0 : 1);
            EXPECT_EQ(std::count(&graph.words[TetraGraph::CELL_WORDS * other + 1],
                                 &graph.words[TetraGraph::CELL_WORDS * other + 5], cell),
                      1);
        }
    }
    EXPECT_EQ(outer, 6u * 9u * 2u);
    EXPECT_EQ(graph.faceCount, outer);
    EXPECT_FALSE(graph.isOdd());
}

TEST(TetraGraph, OuterFacesAreSeenFromOutside)
{
    const TetraSet set = cubes(2);
    const TetraGraph graph = makeTetraGraph(set);
    const glm::dvec3 middle(1.0);
    for (std::size_t f = 0; f < graph.faceCount; ++f) {
        const std::uint32_t* face = &graph.words[graph.facesBegin + TetraGraph::FACE_WORDS * f];
        const glm::dvec3 a = set.vertices.position(face[0]), b = set.vertices.position(face[1]),
                         c = set.vertices.position(face[2]);
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a - middle), 0.0);
    }
}

TEST(TetraGraph, TheTreeHoldsEachFaceWhereItIs)
{
    for (const int n : {1, 3, 4}) {
        const TetraSet set = cubes(n);
        const TetraGraph graph = makeTetraGraph(set);
        ASSERT_GE(graph.leafCount * graph.leafFaces, graph.faceCount);
        ASSERT_EQ(graph.boxes.size(), 4 * graph.leafCount);
        std::set<std::array<std::uint32_t, 3>> seen;
        for (std::size_t f = 0; f < graph.faceCount; ++f) {
            const std::uint32_t* face = &graph.words[graph.facesBegin + TetraGraph::FACE_WORDS * f];
            EXPECT_TRUE(seen.insert({face[0], face[1], face[2]}).second);
            // In its leaf and all above.
            for (std::size_t node = graph.leafCount + f / graph.leafFaces; node > 0; node /= 2)
                for (int i = 0; i < 3; ++i)
                    for (int axis = 0; axis < 3; ++axis) {
                        const double p = set.vertices.position(face[i])[axis];
                        EXPECT_LT(graph.boxes[2 * node][axis], p);
                        EXPECT_GT(graph.boxes[2 * node + 1][axis], p);
                    }
        }
        // Leaves are small: about as large as faces.
        double area = 0.0;
        for (std::size_t leaf = graph.leafCount; leaf < 2 * graph.leafCount; ++leaf) {
            const glm::dvec3 size(graph.boxes[2 * leaf + 1] - graph.boxes[2 * leaf]);
            area += size.x * size.y + size.y * size.z + size.z * size.x;
        }
        EXPECT_LT(area, 2.5 * 6.0 * n * n);
    }
}

TEST(TetraGraph, OddCellsAreCounted)
{
    TetraSet set = cubes(1);
    set.indices.insert(set.indices.end(), {0, 1, 1, 2});
    set.indices.insert(set.indices.end(), set.indices.begin(), set.indices.begin() + 4);
    set.indices.insert(set.indices.end(), {0, 1, 2, 3}); // in a face of the cube
    const TetraGraph graph = makeTetraGraph(set);
    EXPECT_EQ(graph.cellCount, 7u);
    EXPECT_EQ(graph.repeatedVertices, 1u);
    EXPECT_EQ(graph.twice, 1u);
    EXPECT_EQ(graph.flat, 1u);
    EXPECT_EQ(graph.inverted, 3u); // as many as are not
    EXPECT_TRUE(graph.isOdd());
    EXPECT_NE(graph.oddities().find("of 9 tetrahedra"), std::string::npos) << graph.oddities();
}

TEST(TetraGraph, NothingIsAGraphToo)
{
    const TetraGraph graph = makeTetraGraph(setOf({{0, 0, 0}}, {0, 0, 0, 0}));
    EXPECT_EQ(graph.cellCount, 0u);
    EXPECT_EQ(graph.faceCount, 0u);
    EXPECT_EQ(graph.repeatedVertices, 1u);
    EXPECT_EQ(graph.leafCount, 1u);
}

} // namespace TetraGraphTest
