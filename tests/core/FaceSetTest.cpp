#include "osgVolumizer/core/geometry/FaceSet.h"
#include "TestGeometry.h"
#include "osgVolumizer/core/geometry/Outlines.h"

#include <gtest/gtest.h>

namespace FaceSetTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

namespace {

/// A square and a triangle that share an edge.
FaceSet house()
{
    FaceSet set;
    const float points[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 2, 0}};
    for (const auto& p : points)
        set.appendVertex(p);
    const std::uint32_t square[] = {0, 1, 2, 3}, roof[] = {3, 2, 4};
    EXPECT_TRUE(set.appendFace(square, 4).ok());
    EXPECT_TRUE(set.appendFace(roof, 3).ok());
    return set;
}

} // namespace

TEST(FaceSet, IteratesOverFacesAndVertices)
{
    const FaceSet set = house();
    std::size_t faces = 0, corners = 0;
    glm::dvec3 sum(0.0);
    for (const FaceView face : set) {
        ++faces;
        for (const std::uint32_t vertex : face) {
            ++corners;
            sum += set.position(vertex);
        }
    }
    EXPECT_EQ(faces, 2u);
    EXPECT_EQ(corners, 7u);
    EXPECT_EQ(sum, glm::dvec3(3.5, 6.0, 0.0));
    std::vector<std::uint32_t> triangles;
    set.triangulate(0, 2, triangles);
    EXPECT_EQ(triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 3, 2, 4}));
}

TEST(FaceSet, AppendsAndRefuses)
{
    FaceSet set = house();
    ASSERT_TRUE(set.append(set).ok());
    EXPECT_EQ(set.faceCount(), 4u);
    EXPECT_EQ(set.vertexCount(), 10u);
    EXPECT_EQ(set.face(3)[2], 9u);
    const std::uint32_t beyond[] = {0, 1, 10};
    EXPECT_EQ(set.appendFace(beyond, 3).code, ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(set.appendFace(beyond, 3).index, 2);
    EXPECT_EQ(set.appendFace(beyond, 2).code, ErrorCode::VALUE_INVALID);
    FaceSet colored;
    colored.format = VertexFormat(VertexLayout::C4F_V3F);
    EXPECT_EQ(set.append(colored).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(set.faceCount(), 4u);
    set.clear();
    EXPECT_TRUE(set.empty());
    for (const FaceView face : set)
        FAIL() << face.size();
}

TEST(Outlines, EveryEdgeOnce)
{
    LineSet lines;
    outlineFaces(house(), 0, 2, lines);
    EXPECT_EQ(lines.indices.size(), 2u * 6u);
    lines = {};
    outlineTetrahedra(makeBox(glm::dvec3(0.0), glm::dvec3(1.0)), lines);
    EXPECT_EQ(lines.indices.size(), 2u * 18u); // 12 edges and 6 diagonals
    outlineBoxes({{{0, 0, 0}, {1, 2, 3}}, {{1, 0, 0}, {2, 2, 3}}}, lines);
    EXPECT_EQ(lines.indices.size(), 2u * 42u);
    double length = 0.0;
    for (std::size_t i = 36; i < lines.indices.size(); i += 2)
        length += glm::length(lines.points[lines.indices[i]] - lines.points[lines.indices[i + 1]]);
    EXPECT_NEAR(length, 2.0 * 4.0 * (1.0 + 2.0 + 3.0), 1e-12);
}

} // namespace FaceSetTest
