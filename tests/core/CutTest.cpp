#include <osgVolumizer/core/cutting/Cut.h>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace CutTest {

using namespace osgVolumizer::core;

namespace {

// A sphere about a center, of 20 * 4^depth triangles.
TriangleMesh sphereMesh(const glm::dvec3& center, double radius, int depth)
{
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    TriangleMesh mesh;
    mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                     {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                    4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                    6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (int d = 0; d < depth; ++d) {
        TriangleMesh finer;
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
            const glm::dvec3 c[3] = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
            const glm::dvec3 m[3] = {c[0] + c[1], c[1] + c[2], c[2] + c[0]};
            for (const auto& p :
                 {c[0], m[0], m[2], m[0], c[1], m[1], m[2], m[1], c[2], m[0], m[1], m[2]}) {
                finer.indices.push_back(static_cast<std::uint32_t>(finer.vertices.size()));
                finer.vertices.push_back(p);
            }
        }
        for (glm::dvec3& v : finer.vertices)
            v = glm::normalize(v);
        mesh = welded(finer);
    }
    for (glm::dvec3& v : mesh.vertices)
        v = center + radius * glm::normalize(v);
    return mesh;
}

TriangleMesh boxMesh(const Box3d& box)
{
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.push_back(box.corner(i));
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return mesh;
}

} // namespace

TEST(TriangleMesh, KnowsWhetherItIsClosed)
{
    TriangleMesh mesh = sphereMesh({1, 2, 3}, 5.0, 2);
    EXPECT_EQ(mesh.triangleCount(), 320u);
    EXPECT_TRUE(checkClosed(mesh).ok());
    mesh.indices.resize(mesh.indices.size() - 3);
    const auto open = checkClosed(mesh);
    EXPECT_EQ(open.code, osgVolumizer::ErrorCode::VALUE_INVALID);
    EXPECT_NE(open.text.find("belongs to 1 triangle"), std::string::npos) << open.text;
    EXPECT_FALSE(checkClosed(TriangleMesh()).ok());
    mesh.indices.back() = 100000;
    EXPECT_FALSE(checkClosed(mesh).ok());
    mesh.indices.back() = 0;
    mesh.vertices[0].x = NAN;
    EXPECT_FALSE(checkClosed(mesh).ok());
}

TEST(TriangleMesh, ConvexOnesHavePlanes)
{
    const std::vector<Plane> planes = convexFaces(boxMesh({{0, 0, 0}, {1, 2, 3}}), 32);
    ASSERT_EQ(planes.size(), 6u);
    for (const Plane& p : planes) {
        EXPECT_GT(p.distance({0.5, 1.0, 1.5}), 0.4);
        EXPECT_LT(p.distance(glm::dvec3(0.5, 1.0, 1.5) - 5.0 * p.normal), 0.0);
    }
    EXPECT_EQ(convexFaces(sphereMesh({}, 1.0, 0), 32).size(), 20u);
    EXPECT_TRUE(convexFaces(sphereMesh({}, 1.0, 1), 32).empty()); // too many
    TriangleMesh dent = boxMesh({{0, 0, 0}, {1, 1, 1}});
    dent.vertices[7] = {0.2, 0.2, 0.2};
    EXPECT_TRUE(convexFaces(dent, 32).empty());
}

// The surface of a sphere is met to second order in the edges of the grid's cells.
TEST(DistanceField, ConvergesToASmoothSurface)
{
    const glm::dvec3 center(0.3, -0.2, 0.1);
    const TriangleMesh mesh = sphereMesh(center, 7.3, 6);
    std::vector<double> worst;
    for (const int samples : {17, 33, 65}) {
        DistanceField field({glm::dvec3(-10.0), glm::dvec3(10.0)}, glm::ivec3(samples), 4.0);
        field.cutBySurface(mesh, true);
        std::mt19937 random(3);
        std::normal_distribution<double> normal;
        double error = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 d =
                glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            error = std::max(error, std::abs(field.at(center + 7.3 * d)));
        }
        worst.push_back(error);
        EXPECT_NEAR(field.at(center + glm::dvec3(5.3, 0, 0)), 2.0, 0.1); // not at the surface only
        EXPECT_NEAR(field.at(center - glm::dvec3(0, 0, 9.3)), -2.0, 0.1);
        EXPECT_NEAR(field.at(center), 4.0, 1e-6); // as far as it reaches
    }
    EXPECT_GT(std::log2(worst[0] / worst[1]), 1.8);
    EXPECT_GT(std::log2(worst[1] / worst[2]), 1.7); // the mesh has an error of its own
    EXPECT_LT(worst[2], 6e-3);
}

// Random places are inside by the field where they are by the mesh; complement and all.
TEST(DistanceField, TellsInsideFromOutside)
{
    const Box3d box{{-2.3, -1.1, -3.7}, {1.9, 4.4, 2.2}};
    for (const bool inside : {true, false}) {
        DistanceField field({glm::dvec3(-5.0), glm::dvec3(5.0)}, {41, 41, 41}, 1.0);
        field.cutBySurface(boxMesh(box), inside);
        std::mt19937 random(7);
        std::uniform_real_distribution<double> place(-5.0, 5.0);
        for (int i = 0; i < 5000; ++i) {
            const glm::dvec3 p(place(random), place(random), place(random));
            const CutShape shape{box.center(), 0.5 * box.size(), 0.0, inside};
            const double d = shape.distance(p);
            if (std::abs(d) < 0.3) continue;
            EXPECT_EQ(field.at(p) > 0.0, d > 0.0) << p.x << " " << p.y;
        }
    }
}

TEST(DistanceField, RangesHoldWhatIsThere)
{
    DistanceField field({glm::dvec3(0.0), glm::dvec3(30.0, 20.0, 10.0)}, {31, 21, 11}, 3.0);
    field.cutByFunction(
        [](const glm::dvec3& p) { return std::sin(p.x) + std::cos(p.y) + p.z - 5.0; }, false);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-0.1, 1.1);
    for (int i = 0; i < 300; ++i) {
        Box3d box;
        for (int k = 0; k < 2; ++k)
            box.expand(glm::dvec3(unit(random), unit(random), unit(random)) *
                       glm::dvec3(30.0, 20.0, 10.0));
        const ValueRange range = field.rangeIn(box);
        for (int k = 0; k < 20; ++k) {
            const glm::dvec3 f(unit(random), unit(random), unit(random));
            const glm::dvec3 p = box.min + glm::clamp(f, 0.0, 1.0) * box.size();
            EXPECT_LE(range.low, field.at(p) + 1e-6);
            EXPECT_GE(range.high, field.at(p) - 1e-6);
        }
    }
}

TEST(Cut, PartsOfLinesAreThoseOfASphereAndPlanes)
{
    Cut cut;
    cut.shapes.push_back({{0, 0, 0}, glm::dvec3(0.0), 5.0, true});
    cut.shapes.push_back({{0, 0, 0}, glm::dvec3(0.0), 2.0, false});
    cut.planes.push_back({{1.0, 0.0, 0.0}, 4.0});
    const auto parts = cut.keptParts({-10, 0, 0}, {10, 0, 0}, 0.01);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_NEAR(parts[0].first, 0.3, 1e-9);
    EXPECT_NEAR(parts[0].second, 0.4, 1e-9);
    EXPECT_NEAR(parts[1].first, 0.6, 1e-9);
    EXPECT_NEAR(parts[1].second, 0.75, 1e-9);
    EXPECT_TRUE(cut.keptParts({-10, 5.1, 0}, {10, 5.1, 0}, 0.01).empty());
    EXPECT_TRUE(cut.keepsNothingOf({glm::dvec3(-1.0), glm::dvec3(1.0)}));
    EXPECT_FALSE(cut.keepsNothingOf({glm::dvec3(-1.0), glm::dvec3(3.0)}));
    EXPECT_TRUE(cut.keepsAllOf({glm::dvec3(2.8, -0.5, -0.5), glm::dvec3(3.2, 0.5, 0.5)}));
    EXPECT_EQ(cut.share({3, 0, 0}), 1.0);
    EXPECT_EQ(cut.share({1, 0, 0}), 0.0);
    cut.softness = 2.0;
    EXPECT_NEAR(cut.share({4.5, 0, 0}), 0.75, 1e-12);
    EXPECT_FALSE(cut.keepsNothingOf({glm::dvec3(1.1, 0.0, 0.0), glm::dvec3(1.2, 0.1, 0.1)}));
}

} // namespace CutTest
