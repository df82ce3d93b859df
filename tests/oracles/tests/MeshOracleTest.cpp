#include <oracles/ClosedForms.h>
#include <oracles/MeshOracle.h>
#include <oracles/Ray.h>
#include <oracles/TestMeshes.h>

#include <support/Compare.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace MeshOracleTest {

using namespace osgVolumizer;
using namespace osgVolumizer::oracle;

namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

double largestOf(const glm::dvec4& v)
{
    return std::max({std::abs(v.r), std::abs(v.g), std::abs(v.b), std::abs(v.a)});
}

Camera cubeCamera(int size = 32)
{
    Camera c;
    c.view = glm::lookAt(glm::dvec3(1.9, -1.4, 1.7), glm::dvec3(0.5), glm::dvec3(0, 0, 1));
    c.projection = glm::perspective(glm::radians(45.0), 1.0, 0.1, 100.0);
    c.width = c.height = size;
    return c;
}

// With a kink, a jump, a colour that changes, and opacity up to nearly one.
Table jumpTable()
{
    return Table({{0.0, glm::dvec4(0.1, 0.2, 0.3, 0.0)},
                  {0.4, glm::dvec4(1.0, 0.5, 0.0, 0.3)},
                  {0.6, glm::dvec4(0.3, 0.9, 0.0, 0.2)},
                  {0.6, glm::dvec4(0.0, 0.0, 1.0, 0.7)},
                  {1.0, glm::dvec4(1.0, 1.0, 1.0, 0.999)}});
}

// Irregular cells, and some that are almost flat.
TetraMesh roughCube(int n)
{
    TetraMesh mesh = latticeMesh(glm::ivec3(n));
    jitter(mesh, 0.3 / n, 7);
    flatten(mesh, 0.05, 1e-7, 8);
    return mesh;
}

void setScalars(TetraMesh& mesh, const Field& field)
{
    mesh.scalars.clear();
    for (const glm::dvec3& p : mesh.points)
        mesh.scalars.push_back(field.value(p));
}

struct TestRay
{
    glm::dvec3 origin, direction;
};

// From outside towards places inside of the cube.
std::vector<TestRay> raysThroughTheCube(std::size_t count)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(0.0, 1.0), side(-1.0, 1.0);
    std::vector<TestRay> rays;
    while (rays.size() < count) {
        const glm::dvec3 way(side(random), side(random), side(random));
        if (glm::length(way) > 1.0 || glm::length(way) < 0.1) continue;
        const double x = place(random), y = place(random), z = place(random);
        const glm::dvec3 direction = way / glm::length(way);
        rays.push_back({glm::dvec3(x, y, z) - 3.0 * direction, direction});
    }
    return rays;
}

double chordOfCube(const TestRay& ray)
{
    double enter = -INFINITE, leave = INFINITE;
    for (int a = 0; a < 3; ++a) {
        if (ray.direction[a] == 0.0) continue;
        const double t0 = -ray.origin[a] / ray.direction[a];
        const double t1 = (1.0 - ray.origin[a]) / ray.direction[a];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
    }
    return std::max(0.0, leave - enter);
}

Scene cubeScene(std::shared_ptr<const Field> field, const Table& table, double unit)
{
    Scene scene;
    scene.tolerance = 1e-12;
    scene.volumes = {boxVolume(std::move(field), {glm::dvec3(0.0), glm::dvec3(1.0)}, table, unit)};
    return scene;
}

} // namespace

TEST(MeshOracle, AConstantIsOneSegment)
{
    const glm::dvec4 fog(0.5, 0.6, 0.7, 0.4), solid(0.5, 0.6, 0.7, 1.0);
    TetraMesh mesh = roughCube(5);
    mesh.scalars.assign(mesh.points.size(), 0.3);
    const MeshOracle thin(mesh, Table::constant(fog), 0.25),
        thick(mesh, Table::constant(solid), 1.0);
    for (const TestRay& ray : raysThroughTheCube(300)) {
        const double chord = chordOfCube(ray);
        EXPECT_LT(largestOf(thin.light(ray.origin, ray.direction, 0.0, INFINITE) -
                            constantSegment(fog, chord / 0.25)),
                  1e-11);
        // Opacity 1 is taken for 1 - 2^-24; and the parameter's scale does not matter.
        EXPECT_LT(largestOf(thick.light(ray.origin, 2.0 * ray.direction, -INFINITE, INFINITE) -
                            constantSegment({glm::dvec3(solid), 1.0 - 0x1p-24}, chord)),
                  1e-11);
    }
}

TEST(MeshOracle, LinearScalarsDoNotShowTheirCells)
{
    const auto ramp = std::make_shared<RampField>(glm::dvec3(0.5, 0.3, 0.2), 0.0);
    TetraMesh mesh = roughCube(6);
    setScalars(mesh, *ramp);
    const MeshOracle oracle(mesh, jumpTable(), 0.2);
    const Scene scene = cubeScene(ramp, jumpTable(), 0.2);
    const Camera camera = cubeCamera();
    double most = 0.0;
    for (int i = 0; i < 32; ++i) {
        const glm::dvec4 expected = trace(scene, camera, i + 0.5, 0.8 * i + 4.3);
        const glm::dvec4 found = oracle.light(camera, glm::dmat4(1.0), i + 0.5, 0.8 * i + 4.3);
        EXPECT_LT(largestOf(found - expected), 1e-9);
        most = std::max(most, expected.a);
    }
    EXPECT_GT(most, 0.5);
}

TEST(MeshOracle, AgreesWithFineSteps)
{
    const GaussianField field(glm::dvec3(0.4, 0.5, 0.6), 0.3);
    TetraMesh mesh = roughCube(2);
    setScalars(mesh, field);
    const MeshOracle oracle(mesh, jumpTable(), 0.3);
    const TestRay ray{{-1.0, 0.13, 0.31}, {1.0, 0.21, 0.17}};
    // Midpoint steps over the whole of the mesh, from the definition alone.
    const int steps = 200000;
    const double h = 2.0 / steps;
    glm::dvec4 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const glm::dvec3 p = ray.origin + (0.5 + (i + 0.5) * h) * ray.direction;
        double scalar = -1.0;
        for (const TetraMesh::Cell& cell : mesh.cells) {
            const glm::dmat3 edges(mesh.corner(cell, 1) - mesh.corner(cell, 0),
                                   mesh.corner(cell, 2) - mesh.corner(cell, 0),
                                   mesh.corner(cell, 3) - mesh.corner(cell, 0));
            const glm::dvec3 w = glm::inverse(edges) * (p - mesh.corner(cell, 0));
            if (w.x < 0.0 || w.y < 0.0 || w.z < 0.0 || w.x + w.y + w.z > 1.0) continue;
            scalar = (1.0 - w.x - w.y - w.z) * mesh.scalars[cell[0]] + w.x * mesh.scalars[cell[1]] +
                     w.y * mesh.scalars[cell[2]] + w.z * mesh.scalars[cell[3]];
        }
        if (scalar < 0.0) continue;
        const glm::dvec4 color = jumpTable().color(scalar);
        const double alpha =
            -std::expm1(-Table::extinction(color.a) * h * glm::length(ray.direction) / 0.3);
        sum += (1.0 - sum.a) * glm::dvec4(alpha * glm::dvec3(color), alpha);
    }
    EXPECT_GT(sum.a, 0.2);
    EXPECT_LT(largestOf(oracle.light(ray.origin, ray.direction, 0.5, 2.5) - sum), 3e-5);
}

TEST(MeshOracle, PartsOfARayAddUp)
{
    TetraMesh mesh = roughCube(6);
    setScalars(mesh, GaussianField(glm::dvec3(0.4, 0.5, 0.6), 0.3));
    const MeshOracle oracle(mesh, jumpTable(), 0.3);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> part(2.2, 3.8);
    for (const TestRay& ray : raysThroughTheCube(200)) {
        const double middle = part(random);
        const glm::dvec4 front = oracle.light(ray.origin, ray.direction, 0.0, middle);
        const glm::dvec4 back = oracle.light(ray.origin, ray.direction, middle, 6.0);
        const glm::dvec4 whole = oracle.light(ray.origin, ray.direction, 0.0, 6.0);
        EXPECT_LT(largestOf(over(front, back) - whole), 1e-10);
    }
}

TEST(MeshOracle, RefinementIsOfSecondOrder)
{
    const auto field = std::make_shared<GaussianField>(glm::dvec3(0.45, 0.5, 0.6), 0.25);
    const Table table(
        {{0.0, glm::dvec4(1.0, 0.2, 0.0, 0.0)}, {1.0, glm::dvec4(0.2, 1.0, 0.5, 0.6)}});
    const Camera camera = cubeCamera(16);
    const support::FloatImage exact = render(cubeScene(field, table, 0.2), camera);
    for (const HexahedronSplit split : {HexahedronSplit::FIVE, HexahedronSplit::SIX}) {
        std::vector<double> spacings, errors;
        for (const int n : {8, 16, 32}) {
            TetraMesh mesh = latticeMesh(glm::ivec3(n), split);
            sampleField(mesh, *field);
            const support::FloatImage found = render(MeshOracle(mesh, table, 0.2), camera);
            spacings.push_back(1.0 / n);
            errors.push_back(support::compare(found, exact).rmse);
        }
        EXPECT_LT(errors.back(), 1e-3);
        EXPECT_NEAR(support::convergenceOrder(spacings, errors), 2.0, 0.1);
    }
}

TEST(MeshOracle, CellsMayHaveOneScalarEach)
{
    TetraMesh mesh = latticeMesh(glm::ivec3(2));
    mesh.scalarsPerCell = true;
    Scene scene;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        mesh.scalars.push_back(double(c) / double(mesh.cells.size()));
        std::array<glm::dvec3, 4> corners;
        for (std::size_t i = 0; i < 4; ++i)
            corners[i] = mesh.corner(mesh.cells[c], i);
        Volume volume;
        volume.region = tetraRegion(corners);
        volume.field = std::make_shared<ConstantField>(mesh.scalars.back());
        volume.table = jumpTable();
        volume.unit = 0.3;
        scene.volumes.push_back(volume);
    }
    const MeshOracle oracle(mesh, jumpTable(), 0.3);
    const Camera camera = cubeCamera();
    const support::FloatImage expected = render(scene, camera);
    EXPECT_GT(support::coveredPixels(expected, 0.2f).count(), 200u);
    EXPECT_LT(support::compare(render(oracle, camera), expected).maximum, 2e-7); // of floats
}

TEST(MeshOracle, ColoursOfPointsTakeThePlaceOfScalars)
{
    TetraMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}};
    mesh.cells = {{3, 1, 0, 2}};
    const glm::dvec3 color(0.3, 0.5, 0.9);
    for (const double alpha : {0.7, 0.2, 0.2, 0.1})
        mesh.colors.push_back(glm::dvec4(color, alpha));
    const MeshOracle oracle(mesh, Table(), 0.5);
    // Along the edge of corners 0 and 3 or close to it: opacity goes from the one's to the other's.
    const glm::dvec4 edge = oracle.light({0, 0, -1}, {0, 0, 1}, 0.0, INFINITE);
    EXPECT_LT(largestOf(edge - rampSegment(color, 0.7, 0.1, 4.0)), 1e-11);
    const glm::dvec4 inside = oracle.light({0.25, 0.25, -1}, {0, 0, 1}, 0.0, 1.5);
    EXPECT_LT(largestOf(inside - rampSegment(color, 0.45, 0.30, 1.0)), 1e-11);
}

TEST(MeshOracle, TheCellEnteredFirstHidesWhatItOverlaps)
{
    const glm::dvec4 a(1.0, 0.0, 0.0, 0.3), b(0.0, 0.0, 1.0, 0.6);
    TetraMesh mesh = latticeMesh(glm::ivec3(1), HexahedronSplit::SIX), other = mesh;
    transform(other, glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 0.75)));
    append(mesh, other);
    mesh.scalarsPerCell = true;
    mesh.scalars.assign(6, 0.0);
    mesh.scalars.resize(12, 1.0);
    const MeshOracle oracle(mesh, Table({{0.0, a}, {1.0, b}}), 1.0);
    // Along z through one cell of each cube only: a line beside the diagonal's edges.
    const auto cellsAlong = oracle.segments({0.0, 0.0, -1.0}, {0, 0, 1}, 0.0, INFINITE);
    ASSERT_EQ(cellsAlong.size(), 2u);
    EXPECT_LT(largestOf(oracle.light({0, 0, -1}, {0, 0, 1}, 0.0, INFINITE) -
                        over(constantSegment(a, 1.0), constantSegment(b, 0.75))),
              1e-11);
    EXPECT_LT(largestOf(oracle.light({0, 0, 3}, {0, 0, -1}, 0.0, INFINITE) -
                        over(constantSegment(b, 1.0), constantSegment(a, 0.75))),
              1e-11);
    // A ray that starts where both are has entered the first already.
    EXPECT_LT(largestOf(oracle.light({0, 0, 0.8}, {0, 0, 1}, 0.0, INFINITE) -
                        over(constantSegment(a, 0.2), constantSegment(b, 0.75))),
              1e-11);
}

TEST(MeshOracle, LeavesOutWhatHasNoVolumeOrNoValue)
{
    const glm::dvec4 fog(0.5, 0.6, 0.7, 0.4);
    TetraMesh mesh;
    // Two cells one behind the other along z, one that is flat, one of a point that is not finite.
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2},
                   {1, 0, 2}, {0, 1, 2}, {0, 0, 3}, {1, 1, 0}, {0, 0, INFINITE}};
    mesh.cells = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 2, 8}, {0, 1, 2, 9}};
    mesh.scalars.assign(mesh.points.size(), 0.5);
    const glm::dvec3 origin(0.1, 0.1, -1), direction(0, 0, 1);
    const auto lengthUnits = [&] {
        const glm::dvec4 light =
            MeshOracle(mesh, Table::constant(fog), 1.0).light(origin, direction, 0.0, INFINITE);
        return std::log1p(-light.a) / std::log1p(-fog.a);
    };
    EXPECT_NEAR(lengthUnits(), 1.6, 1e-11);
    mesh.scalars[6] = std::nan("");
    EXPECT_NEAR(lengthUnits(), 0.8, 1e-11);
    mesh.scalars[0] = INFINITE;
    EXPECT_EQ(lengthUnits(), 0.0);
}

TEST(MeshOracle, SegmentsLeaveNoGaps)
{
    TetraMesh rough = roughCube(8), regular = latticeMesh(glm::ivec3(8));
    rough.scalars.assign(rough.points.size(), 0.0);
    regular.scalars = rough.scalars;
    const MeshOracle roughOracle(rough, Table(), 1.0), regularOracle(regular, Table(), 1.0);
    for (const TestRay& ray : raysThroughTheCube(500)) {
        const auto segments = roughOracle.segments(ray.origin, ray.direction, 0.0, INFINITE);
        ASSERT_FALSE(segments.empty());
        for (std::size_t i = 0; i + 1 < segments.size(); ++i)
            EXPECT_EQ(segments[i].leave, segments[i + 1].enter);
        EXPECT_NEAR(segments.back().leave - segments.front().enter, chordOfCube(ray), 1e-12);
    }
    // In the faces, and along the edges, of regular cells, and through their corners.
    for (int i = 0; i <= 8; ++i)
        for (const TestRay& ray :
             {TestRay{{i / 8.0, 0.3, -1.0}, {0, 0, 1}}, TestRay{{i / 8.0, 0.5, -1.0}, {0, 0, 1}},
              TestRay{{i / 8.0, 1.0, 2.0}, {0, 0, -1}},
              TestRay{{i / 8.0, -1.0, -1.0}, {0, 1, 1}}}) {
            double sum = 0.0;
            for (const auto& s : regularOracle.segments(ray.origin, ray.direction, 0.0, INFINITE))
                sum += s.leave - s.enter;
            EXPECT_NEAR(sum, 1.0, 1e-12);
        }
}

TEST(MeshOracle, MovedAndScaledMeshesLookTheSame)
{
    TetraMesh mesh = roughCube(5);
    setScalars(mesh, GaussianField(glm::dvec3(0.4, 0.5, 0.6), 0.3));
    const Camera camera = cubeCamera();
    const support::FloatImage plain = render(MeshOracle(mesh, jumpTable(), 0.3), camera);
    for (const double scale : {1e-3, 1.0, 1e6}) {
        const glm::dmat4 map =
            glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(1e6 * scale)), glm::dvec3(scale));
        TetraMesh moved = mesh;
        transform(moved, map);
        const MeshOracle oracle(moved, jumpTable(), 0.3 * scale);
        const support::FloatImage picture = render(oracle, camera, glm::inverse(map));
        EXPECT_LT(support::compare(picture, plain).maximum, 1e-6) << scale;
    }
}

TEST(MeshOracle, APictureMayHaveEveryFourthPixel)
{
    TetraMesh mesh = roughCube(3);
    setScalars(mesh, GaussianField(glm::dvec3(0.4, 0.5, 0.6), 0.3));
    const MeshOracle oracle(mesh, jumpTable(), 0.3);
    const support::FloatImage whole = render(oracle, cubeCamera(30));
    const support::FloatImage sparse = render(oracle, cubeCamera(30), glm::dmat4(1.0), 4);
    ASSERT_EQ(sparse.width, 7);
    ASSERT_EQ(sparse.height, 7);
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 7; ++x)
            EXPECT_EQ(sparse.at(x, y), whole.at(4 * x + 2, 4 * y + 2));
}

} // namespace MeshOracleTest
