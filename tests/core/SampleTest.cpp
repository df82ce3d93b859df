#include "osgVolumizer/core/sampling/Sample.h"
#include "TestGeometry.h"
#include "osgVolumizer/core/geometry/ConvexPieces.h"

#include <gtest/gtest.h>

#include <random>

namespace SampleTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

namespace {

/// Planes across a direction.
class Planes : public SurfaceFamily
{
public:
    explicit Planes(const glm::dvec3& direction) : _direction(glm::normalize(direction)) {}
    double depth(const glm::dvec3& p, const glm::dvec3&) const override
    {
        return glm::dot(_direction, p);
    }
    double spacing() const override { return 0.25; }

private:
    glm::dvec3 _direction;
};

/// Cylinders about the z axis: a family of the user's that is not linear.
class Cylinders : public SurfaceFamily
{
public:
    double depth(const glm::dvec3& p, const glm::dvec3&) const override
    {
        return std::sqrt(p.x * p.x + p.y * p.y);
    }
    double spacing() const override { return 0.25; }
    double tolerance() const override { return 0.02; }
};

/// Exact area of the cut of the unit cube by dot(n, p) = d, |n| = 1: derivative of the volume below
/// (Barrow and Smith, "Spline notation applied to a volume problem", 1979).
double cubeSection(const glm::dvec3& n, double d)
{
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 v(i & 1, i >> 1 & 1, i >> 2 & 1);
        const double x = std::max(0.0, d - glm::dot(n, v));
        sum += ((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) % 2 ? -x * x : x * x;
    }
    return sum / (2.0 * n.x * n.y * n.z);
}

} // namespace

TEST(Sample, FacesOfOnePlaneTileTheCrossSection)
{
    const TetraSet grid = makeGrid(4, 1.0);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> u(0.1, 1.0);
    for (int round = 0; round < 20; ++round) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(u(random), u(random), u(random)));
        const double d = u(random) * (n.x + n.y + n.z);
        PolygonSet faces, boxed;
        faces.format = boxed.format = grid.vertices.format();
        for (std::size_t t = 0; t < grid.tetraCount(); ++t)
            ASSERT_TRUE(sample(grid, t, Planes(n), {d}, faces).ok());
        const double exact = cubeSection(n, d);
        EXPECT_NEAR(area(faces), exact, 1e-12 * exact + 1e-15);
        for (std::size_t f = 0; f < faces.faceCount(); ++f)
            EXPECT_LE(glm::dot(faces.normal(f), n), 0.0); // towards the near side
        for (int i = 0; i < 8; ++i)
            clip(faces,
                 {{i & 1 ? 0.3 : 0.0, i & 2 ? 0.5 : 0.0, i & 4 ? 0.71 : 0.0},
                  {i & 1 ? 1.0 : 0.3, i & 2 ? 1.0 : 0.5, i & 4 ? 1.0 : 0.71}},
                 boxed);
        EXPECT_NEAR(area(boxed), exact, 1e-12 * exact + 1e-15);
    }
}

TEST(Sample, HalfSpacesSplitAllFieldsWithoutGapOrOverlap)
{
    TetraSet set = makeBox(glm::dvec3(0.0), glm::dvec3(2.0));
    TetraSet colored;
    colored.vertices = VertexArray(VertexFormat::user(3, 4, 5));
    colored.vertices.resize(8);
    colored.indices = set.indices;
    const auto field = [](const glm::dvec3& p, int k) { return 3.0 * p.x - p.y * k + 0.5 * p.z; };
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::dvec3 p = set.vertices.position(i);
        for (int k = 0; k < 15; ++k)
            colored.vertices.record(i)[k] = field(p, k);
        colored.vertices.setPosition(i, p);
    }
    PolygonSet faces;
    faces.format = colored.vertices.format();
    for (std::size_t t = 0; t < 5; ++t)
        ASSERT_TRUE(sample(colored, t, Planes({1, 2, 3}), {1.0, 2.0, 3.0}, faces).ok());
    const Plane half{{0.3, -0.2, 0.7}, -0.4};
    PolygonSet a, b;
    a.format = b.format = faces.format;
    clip(faces, {half}, a);
    clip(faces, {{-half.normal, -half.offset}}, b);
    EXPECT_NEAR(area(a) + area(b), area(faces), 1e-13 * area(faces));
    EXPECT_GT(area(a), 0.1);
    EXPECT_GT(area(b), 0.1);
    for (std::size_t f = 0; f < a.faceCount(); ++f)
        for (std::size_t c = 0; c < a.size(f); ++c)
            for (int k = 0; k < 15; ++k)
                if (k < 7 || k > 9) {
                    EXPECT_NEAR(a.record(f, c)[k], field(a.position(f, c), k), 1e-13);
                }
}

TEST(Sample, RefusesBadIndices)
{
    PolygonSet out;
    EXPECT_EQ(
        sample(makeBox(glm::dvec3(0.0), glm::dvec3(1.0)), 5, Planes({1, 0, 0}), {0.5}, out).code,
        ErrorCode::INDEX_OUT_OF_RANGE);
}

TEST(Mpr, PlaneAndPolygonThroughBricks)
{
    Polygonizer p;
    ASSERT_TRUE(p.setTetraSet(std::make_shared<TetraSet>(makeGrid(4, 8.0))).ok());
    std::vector<Box3d> bricks{{{0, 0, 0}, {3, 8, 8}}, {{3, 0, 0}, {8, 8, 8}}};
    ASSERT_TRUE(p.setClipBoxes(bricks).ok());
    PolygonizedFaces out;
    ASSERT_TRUE(p.polygonizeMPR(Plane{{0, 0, 2}, -7.0}, glm::dvec3(0.0), out).ok());
    ASSERT_EQ(out.surfaceCount, 1);
    glm::dvec3 normal(0.0);
    EXPECT_NEAR(area(out.faces, out.range(0, 0), &normal), 24.0, 1e-5);
    EXPECT_NEAR(area(out.faces, out.range(0, 1), &normal), 40.0, 1e-5);
    EXPECT_NEAR(normal.z, 64.0, 1e-4);
    for (std::uint32_t v = 0; v < out.faces.vertexCount(); ++v)
        EXPECT_EQ(out.faces.position(v).z, 3.5);
    // A plane that misses.
    ASSERT_TRUE(p.polygonizeMPR(Plane{{0, 0, 1}, -9.0}, glm::dvec3(0.0), out).ok());
    EXPECT_EQ(out.faces.faceCount(), 0u);
    // An L, partly outside: 2 x 6 and 4 x 2, of which x > 8 is missing.
    const std::vector<glm::dvec3> l{{4, 1, 5.3}, {10, 1, 5.3}, {10, 3, 5.3},
                                    {6, 3, 5.3}, {6, 7, 5.3},  {4, 7, 5.3}};
    ASSERT_TRUE(p.polygonizeMPR(l, glm::dvec3(0.0), out).ok());
    EXPECT_NEAR(area(out.faces, out.range(0, 1)), 2.0 * 6.0 + 2.0 * 2.0, 1e-5);
    EXPECT_EQ(out.range(0, 0).faceCount, 0u);
    ASSERT_TRUE(
        p.polygonizeMPR({{1, 1, 1}, {7, 1, 2}, {7, 7, 5}, {1, 7, 4}}, glm::dvec3(0.0), out).ok());
    const double whole = glm::length(glm::cross(glm::dvec3(6, 0, 1), glm::dvec3(0, 6, 3)));
    EXPECT_NEAR(area(out.faces, out.range(0, 0)) + area(out.faces, out.range(0, 1)), whole, 1e-4);
}

TEST(Mpr, RefusesWhatIsNoPlaneOrPolygon)
{
    Polygonizer p;
    ASSERT_TRUE(p.setTetraSet(std::make_shared<TetraSet>(makeGrid(1, 1.0))).ok());
    PolygonizedFaces out;
    const glm::dvec3 o(0.0);
    EXPECT_EQ(p.polygonizeMPR(Plane{{0, 0, 0}, 1.0}, o, out).code, ErrorCode::VALUE_INVALID);
    using Points = std::vector<glm::dvec3>;
    EXPECT_EQ(p.polygonizeMPR(Points{{0, 0, 0}, {1, 0, 0}}, o, out).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(p.polygonizeMPR(Points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, o, out).code,
              ErrorCode::VALUE_INVALID);
    const Status bent =
        p.polygonizeMPR(Points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}}, o, out);
    EXPECT_EQ(bent.code, ErrorCode::VALUE_INVALID);
}

TEST(Sample, UserFamilyOfCylindersFillsTheVolume)
{
    Polygonizer p;
    TetraSet set = makeBox({0.5, 0.5, 0.0}, {4.5, 3.5, 2.0});
    ASSERT_TRUE(p.setTetraSet(std::make_shared<TetraSet>(std::move(set))).ok());
    PolygonizedFaces out;
    ASSERT_TRUE(p.polygonize(Cylinders(), SamplingParameters(), out).ok());
    double volume = 0.0;
    for (int s = 0; s < out.surfaceCount; ++s) {
        volume += area(out.faces, out.range(s, 0)) * out.spacing;
        for (std::uint32_t f = out.range(s, 0).firstIndex;
             f < out.range(s, 0).firstIndex + out.range(s, 0).indexCount; ++f) {
            const glm::dvec3 q = out.faces.position(out.faces.indices[f]);
            EXPECT_NEAR(std::sqrt(q.x * q.x + q.y * q.y), out.surfaceDepths[std::size_t(s)],
                        0.02 * 0.25 + 1e-6);
        }
    }
    EXPECT_NEAR(volume, 24.0, 0.03);
}

} // namespace SampleTest
