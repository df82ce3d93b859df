// Unstructured grids: scalars of vertices and of tetrahedra against the light of each cell in
// double precision, whatever the mesh looks like.
#include "Volumes.h"

#include <osgVolumizer/VolumeCut.h>

#include <oracles/MeshOracle.h>
#include <oracles/Ray.h>
#include <oracles/TestMeshes.h>
#include <support/GLTest.h>
#include <support/Instrumented.h>
#include <support/Reports.h>

#include <glm/gtc/matrix_transform.hpp>

#include <fstream>
#include <iterator>

namespace MeshTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

/// A field of one bump with some detail, 0 to 1 in the unit cube.
class Bump : public oracle::Field
{
public:
    double value(const glm::dvec3& p) const override
    {
        const glm::dvec3 d = p - glm::dvec3(0.45, 0.55, 0.5);
        return 0.8 * std::exp(-6.0 * glm::dot(d, d)) +
               0.1 * std::sin(5.0 * p.x) * std::cos(4.0 * p.z);
    }
    glm::dvec3 gradient(const glm::dvec3&) const override { return glm::dvec3(0.0); }
};

Points colorfulPoints()
{
    return {{0.0, {0.1, 0.2, 0.9, 0.0}},
            {0.3, {0.9, 0.3, 0.1, 0.05}},
            {0.5, {0.2, 0.9, 0.3, 0.6}},
            {0.5, {0.9, 0.9, 0.1, 0.1}},
            {1.0, {1.0, 0.5, 0.8, 0.7}}};
}

/// A mesh in OSG and the same one for the oracle.
struct TwinMesh
{
    osg::ref_ptr<VolumeAppearance> node;
    osg::ref_ptr<VolumeGeometry> geometry;
    std::shared_ptr<oracle::MeshOracle> oracle;
};

const glm::dvec2 RANGE(-0.1, 0.9);

osg::ref_ptr<VolumeGeometry> geometryOf(const oracle::TetraMesh& mesh)
{
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    core::TetraSet set = oracle::tetraSet(mesh);
    if (!mesh.colors.empty()) {
        const core::VertexArray places = set.vertices;
        set.vertices = core::VertexArray(core::VertexLayout::C4F_V3F);
        set.vertices.resize(mesh.points.size());
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            set.vertices.setPosition(i, places.position(i));
            for (int k = 0; k < 4; ++k)
                set.vertices.record(i)[k] = mesh.colors[i][k];
        }
    }
    EXPECT_TRUE(geometry->setTetraSet(std::move(set)).ok());
    if (!mesh.colors.empty()) return geometry;
    EXPECT_TRUE(geometry->setScalarRange(osg::Vec2d(RANGE.x, RANGE.y)).ok());
    EXPECT_TRUE(geometry
                    ->setScalars({mesh.scalars.begin(), mesh.scalars.end()},
                                 mesh.scalarsPerCell ? VolumeGeometry::PER_TETRAHEDRON
                                                     : VolumeGeometry::PER_VERTEX)
                    .ok());
    return geometry;
}

TwinMesh makeTwin(const oracle::TetraMesh& mesh, const Points& points, double unit)
{
    TwinMesh twin;
    twin.geometry = geometryOf(mesh);
    twin.node = new VolumeAppearance;
    twin.node->setLookupTable(makeTable(points));
    twin.node->setOpacityUnit(unit);
    twin.node->addChild(twin.geometry);
    twin.oracle = std::make_shared<oracle::MeshOracle>(mesh, oracle::Table(points, RANGE), unit);
    return twin;
}

/// From a direction, in radii from the middle.
support::RenderOptions viewFrom(const osg::Vec3d& direction, const osg::BoundingSphere& bound,
                                bool orthographic = false)
{
    support::RenderOptions options;
    options.size(96, 96);
    const osg::Vec3d center = bound.center();
    options.lookAt(center + direction * bound.radius(), center, osg::Vec3d(0.1, 0.2, 1.0));
    if (orthographic)
        options.orthographic(1.05 * bound.radius());
    else
        options.perspective(30.0);
    return options;
}

support::Difference difference(const TwinMesh& twin, const support::RenderOptions& options,
                               const std::string& name)
{
    const support::FloatImage picture = support::renderScene(twin.node, options);
    const support::FloatImage expected =
        oracle::render(*twin.oracle, support::oracleCamera(options));
    support::savePicture(picture, "mesh_" + name);
    const support::Difference d = support::compare(picture, expected);
    std::printf("  %-18s rmse %.1e, maximum %.1e at %d %d, bias %.1e, %zu pixels\n", name.c_str(),
                d.rmse, d.maximum, d.worstX, d.worstY, d.bias, d.pixels);
    return d;
}

/// Of a jittered lattice of hexahedra in five tetrahedra each.
oracle::TetraMesh jittered(int n)
{
    oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(n));
    oracle::jitter(mesh, 0.2 / n, 7);
    return mesh;
}

const osg::Vec3d OBLIQUE(3.1, 2.2, 1.3);

class MeshTest : public support::GLTest
{
protected:
    void expectExact(oracle::TetraMesh mesh, const std::string& name, bool perCell = false)
    {
        oracle::sampleField(mesh, Bump(), perCell);
        const TwinMesh twin = makeTwin(mesh, colorfulPoints(), 0.1);
        const auto bound = twin.node->getBound();
        EXPECT_LT(difference(twin, viewFrom(OBLIQUE, bound), name).rmse, 1e-5) << name;
        EXPECT_LT(difference(twin, viewFrom({-2.0, 1.0, -3.0}, bound, true), name + "_ortho").rmse,
                  1e-5)
            << name;
    }
};

} // namespace

TEST_F(MeshTest, IsExactAtAnySize)
{
    // 135, 8 640 and 975 560 tetrahedra.
    for (const int n :
         support::INSTRUMENTED ? std::vector<int>{3, 12} : std::vector<int>{3, 12, 58})
        expectExact(jittered(n), "size" + std::to_string(n));
}

TEST_F(MeshTest, ErrorFallsWithTheSquareOfTheCellSize)
{
    // Of the same field, not interpolated: a fine mesh of the oracle's stands for it.
    const Points smooth = {{0.0, {0.1, 0.2, 0.9, 0.0}}, {1.0, {1.0, 0.5, 0.8, 0.4}}};
    oracle::TetraMesh fine = oracle::latticeMesh(glm::ivec3(64));
    oracle::sampleField(fine, Bump());
    const auto truth = makeTwin(fine, smooth, 0.1);
    const auto options = viewFrom(OBLIQUE, truth.node->getBound());
    const support::FloatImage expected =
        oracle::render(*truth.oracle, support::oracleCamera(options));
    std::vector<double> sizes, errors;
    for (const int n : {4, 8, 16}) {
        oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(n));
        oracle::sampleField(mesh, Bump());
        const auto twin = makeTwin(mesh, smooth, 0.1);
        sizes.push_back(1.0 / n);
        errors.push_back(support::compare(support::renderScene(twin.node, options), expected).rmse);
    }
    EXPECT_GT(support::convergenceOrder(sizes, errors), 1.8);
    EXPECT_LT(errors.back(), 3e-3);
}

TEST_F(MeshTest, IsExactWhateverItsShape)
{
    expectExact(oracle::cornerMesh(8), "corner");
    expectExact(oracle::holeMesh(9, oracle::HexahedronSplit::SIX), "hole");
    expectExact(oracle::twoPieceMesh(9), "pieces");
    oracle::TetraMesh bars = oracle::cyclicBars(6);
    oracle::transform(
        bars, glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(0.5)), glm::dvec3(0.4)));
    expectExact(bars, "cyclic");
    oracle::TetraMesh slivers = oracle::latticeMesh(glm::ivec3(14));
    EXPECT_GT(oracle::flatten(slivers, 0.3, 1e-4, 3), 1000u);
    expectExact(slivers, "slivers");
}

TEST_F(MeshTest, ScalarsOfTetrahedraAreConstantInThem)
{
    expectExact(jittered(8), "cells", true);
}

TEST_F(MeshTest, ColoursOfVerticesAreLinear)
{
    oracle::TetraMesh mesh = jittered(6);
    for (const glm::dvec3& p : mesh.points)
        mesh.colors.emplace_back(glm::vec4(p.x, 1.0 - p.y, p.z, 0.02 + 0.5 * p.x * p.x * p.y));
    for (const double unit : {1.0, 0.05}) {
        const TwinMesh twin = makeTwin(mesh, colorfulPoints(), unit);
        const auto options = viewFrom(OBLIQUE, twin.node->getBound());
        EXPECT_LT(difference(twin, options, "colours").rmse, 1e-5);
    }
}

TEST_F(MeshTest, RaysMayLieInFacesAndEdges)
{
    oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(8));
    oracle::sampleField(mesh, Bump());
    const TwinMesh twin = makeTwin(mesh, colorfulPoints(), 0.1);
    // 96 pixels over 12 hexahedra: every eighth ray between pixels, and shifted by half a pixel in
    // them.
    for (const double shift : {0.0, 0.5}) {
        support::RenderOptions options;
        options.size(96, 96);
        const double x = 0.5 + shift / 64.0;
        options.lookAt({x, -3.0, x}, {x, 0.5, x}, {0, 0, 1}).orthographic(0.75);
        const support::FloatImage expected =
            oracle::render(*twin.oracle, support::oracleCamera(options));
        // Rays in the outer faces may be in or out.
        const support::Mask inside = support::eroded(support::coveredPixels(expected), 1);
        const support::Difference d =
            support::compare(support::renderScene(twin.node, options), expected, inside);
        EXPECT_GT(d.pixels, 3800u);
        EXPECT_LT(d.rmse, 1e-5);
        EXPECT_LT(d.maximum, 1e-4);
    }
}

TEST_F(MeshTest, TheCameraMayBeInside)
{
    oracle::TetraMesh mesh = jittered(8);
    oracle::sampleField(mesh, Bump());
    const TwinMesh twin = makeTwin(mesh, colorfulPoints(), 0.1);
    support::RenderOptions options;
    options.size(96, 96).perspective(70.0).lookAt({0.45, 0.52, 0.4}, {0.9, 0.8, 0.6}, {0, 0, 1});
    options.computeNearFar = false;
    options.projection = osg::Matrixd::perspective(70.0, 1.0, 1e-4, 10.0);
    oracle::Camera camera = support::oracleCamera(options);
    camera.nearDepth = 1e-4;
    const support::Difference d = support::compare(support::renderScene(twin.node, options),
                                                   oracle::render(*twin.oracle, camera));
    EXPECT_LT(d.rmse, 1e-5);
    EXPECT_GT(d.pixels, 9000u);
}

TEST_F(MeshTest, MayBeFarAwayAndSmall)
{
    for (const glm::dmat4& map : {glm::translate(glm::dmat4(1.0), glm::dvec3(6.4e6, -3.2e6, 1.0e6)),
                                  glm::scale(glm::dmat4(1.0), glm::dvec3(1e-6))}) {
        oracle::TetraMesh mesh = jittered(8);
        oracle::sampleField(mesh, Bump());
        oracle::transform(mesh, map);
        const double unit = 0.1 * std::cbrt(glm::determinant(glm::dmat3(map)));
        const TwinMesh twin = makeTwin(mesh, colorfulPoints(), unit);
        support::RenderOptions options;
        const glm::dvec3 c(map * glm::dvec4(0.5, 0.5, 0.5, 1.0));
        const osg::Vec3d center(c.x, c.y, c.z);
        options.size(96, 96).perspective(30.0).lookAt(center + OBLIQUE * (0.87 * 10.0 * unit),
                                                      center, {0.1, 0.2, 1.0});
        EXPECT_LT(difference(twin, options, "faraway").rmse, 1e-5);
    }
}

TEST_F(MeshTest, OtherRayFunctionsFindWhatTheyAskFor)
{
    oracle::TetraMesh mesh = jittered(6);
    oracle::sampleField(mesh, oracle::RampField(glm::dvec3(0.1, 0.2, 0.4), 0.05));
    const TwinMesh twin = makeTwin(mesh, {{0.0, {0, 0, 0, 1}}, {1.0, {1, 1, 1, 1}}}, 0.1);
    const auto options = viewFrom(OBLIQUE, twin.node->getBound());
    const oracle::Camera camera = support::oracleCamera(options);
    const glm::dmat4 toWorld = glm::inverse(camera.view);
    using A = VolumeAppearance;
    for (const auto function : {A::MAXIMUM, A::MINIMUM, A::AVERAGE, A::ISOSURFACE}) {
        twin.node->setRayFunction(function);
        twin.node->setIsoValue(0.4);
        const support::FloatImage picture = support::renderScene(twin.node, options);
        support::savePicture(picture, std::string("mesh_") + A::RAY_FUNCTION_NAMES[function]);
        double most = 0.0;
        for (int y = 8; y < 96; y += 8)
            for (int x = 8; x < 96; x += 8) {
                const oracle::Ray eye = oracle::rayThrough(camera, x + 0.5, y + 0.5);
                const glm::dvec3 origin(toWorld * glm::dvec4(eye.origin, 1.0));
                const glm::dvec3 direction(toWorld * glm::dvec4(eye.direction, 0.0));
                const auto parts = twin.oracle->segments(origin, direction, -INFINITY, INFINITY);
                if (parts.empty()) continue;
                const auto value = [&](double t) {
                    return glm::dot(origin + t * direction, glm::dvec3(0.1, 0.2, 0.4)) + 0.05;
                };
                const double a = value(parts.front().enter), b = value(parts.back().leave);
                const bool crosses = (a < 0.4) != (b < 0.4);
                const double expected = function == A::MAXIMUM     ? std::max(a, b)
                                        : function == A::MINIMUM   ? std::min(a, b)
                                        : function == A::AVERAGE   ? 0.5 * (a + b)
                                        : /* isosurface */ crosses ? 0.4
                                                                   : RANGE.x;
                const double shown = picture.pixels[std::size_t(y * 96 + x)].r;
                most = std::max(most, std::abs(shown - (expected - RANGE.x)));
            }
        EXPECT_LT(most, 2e-3) << A::RAY_FUNCTION_NAMES[function];
    }
}

TEST_F(MeshTest, TablesMayBeOpaque)
{
    // Ramps to opacity 1 and beyond, of points and of cells, thin and thick; one point alone.
    const Points ramp = {{0.0, {1, 0.2, 0.1, 0.0}}, {0.6, {0.1, 0.2, 1, 1.0}}};
    for (const bool perCell : {false, true})
        for (const double unit : {0.02, 10.0})
            for (const Points& points : {ramp, Points{{0.5, {0.3, 0.6, 0.9, 1.0}}}}) {
                oracle::TetraMesh mesh = jittered(4);
                oracle::sampleField(mesh, Bump(), perCell);
                const TwinMesh twin = makeTwin(mesh, points, unit);
                const auto options = viewFrom(OBLIQUE, twin.node->getBound());
                EXPECT_LT(difference(twin, options, "opaque").rmse, perCell ? 3e-5 : 1e-5) << unit;
            }
    oracle::TetraMesh mesh = jittered(4);
    for (const glm::dvec3& p : mesh.points)
        mesh.colors.emplace_back(p.x, p.y, p.z, 1.0);
    const TwinMesh twin = makeTwin(mesh, ramp, 1.0);
    EXPECT_LT(difference(twin, viewFrom(OBLIQUE, twin.node->getBound()), "solid").rmse, 1e-5);
}

TEST_F(MeshTest, CopiesAndAnyValuesAreShown)
{
    oracle::TetraMesh mesh = jittered(4);
    oracle::sampleField(mesh, Bump());
    const TwinMesh twin = makeTwin(mesh, colorfulPoints(), 0.1);
    const auto options = viewFrom(OBLIQUE, twin.node->getBound());
    const support::FloatImage expected = support::renderScene(twin.node, options);
    twin.node->setChild(0, osg::clone(twin.geometry.get(), osg::CopyOp::DEEP_COPY_ALL));
    EXPECT_EQ(support::compare(support::renderScene(twin.node, options), expected).maximum, 0.0);
    // Fill values, far beyond the table; nothing at all.
    twin.node->setChild(0, twin.geometry);
    std::vector<float> scalars(mesh.points.size(), 9.97e36f);
    for (const float value : {9.97e36f, -3e38f, 0.0f, NAN}) {
        std::fill(scalars.begin(), scalars.end(), value);
        scalars[3] = 0.4f;
        ASSERT_TRUE(twin.geometry->setScalars(scalars).ok());
        const support::FloatImage picture = support::renderScene(twin.node, options);
        for (const glm::vec4& pixel : picture.pixels)
            ASSERT_TRUE(pixel.a >= 0.0f && pixel.a <= 1.0f) << value;
        EXPECT_EQ(support::coveredPixels(picture, 0.1f).count() > 0, value >= 0.0f) << value;
    }
}

TEST_F(MeshTest, CutsHaveEdgesWithinTetrahedra)
{
    // A box of five tetrahedra without the ball in its middle.
    oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(1));
    mesh.scalars.assign(mesh.points.size(), 0.4);
    const Points constant = {{0.0, {0.8, 0.4, 0.2, 0.3}}};
    const TwinMesh twin = makeTwin(mesh, constant, 0.3);
    osg::ref_ptr<VolumeCut> cut = new VolumeCut;
    cut->addRegion(CutRegion::sphere({0.5, 0.5, 0.5}, 0.4).complement());
    twin.node->setCut(cut);
    const auto options = viewFrom(OBLIQUE, twin.node->getBound(), true);
    const support::FloatImage picture = support::renderScene(twin.node, options);
    support::savePicture(picture, "mesh_cut");
    // Through the middle what is left is shorter by the ball.
    const auto depthOf = [](float alpha) { return -std::log1p(-double(alpha)); };
    twin.node->setCut(nullptr);
    const support::FloatImage whole = support::renderScene(twin.node, options);
    const std::size_t middle = 48 * 96 + 48;
    const double extinction = -std::log1p(-0.3) / 0.3;
    EXPECT_NEAR(depthOf(whole.pixels[middle].a) - depthOf(picture.pixels[middle].a),
                extinction * 0.8, 0.01);
}

TEST_F(MeshTest, OddCellsAreLeftOutAndCountedOnce)
{
    oracle::TetraMesh mesh = jittered(4);
    mesh.points.emplace_back(0.3, 0.3, 0.3); // isolated
    oracle::sampleField(mesh, Bump());
    std::swap(mesh.cells[5][0], mesh.cells[5][1]);                              // inverted
    mesh.scalars[mesh.cells[20][2]] = std::numeric_limits<double>::quiet_NaN(); // no value
    mesh.scalars[mesh.cells[77][0]] = std::numeric_limits<double>::infinity();
    oracle::TetraMesh odd = mesh;
    odd.cells.push_back({0, 1, 1, 2}); // a point twice
    odd.cells.push_back(odd.cells[7]); // a cell twice
    odd.cells.push_back(odd.cells[9]);
    std::swap(odd.cells.back()[0], odd.cells.back()[3]); // and in another order
    const support::Reports reports;
    TwinMesh twin = makeTwin(odd, colorfulPoints(), 0.1);
    twin.oracle =
        std::make_shared<oracle::MeshOracle>(mesh, oracle::Table(colorfulPoints(), RANGE), 0.1);
    const auto bound = twin.node->getBound();
    EXPECT_LT(difference(twin, viewFrom(OBLIQUE, bound), "odd").rmse, 1e-5);
    EXPECT_LT(difference(twin, viewFrom({1.0, -3.0, 0.5}, bound), "odd2").rmse, 1e-5);
    EXPECT_EQ(reports.all(), 1u);
    for (const char* what : {"1 with a vertex twice", "2 of the same vertices", "1 inverted"})
        EXPECT_EQ(reports.count(what), 1) << what;
}

TEST_F(MeshTest, FacesOfManyTetrahedraAndFlatOnes)
{
    // Three tetrahedra on one face, two of which overlap: of these the first on the ray is drawn.
    oracle::TetraMesh mesh;
    mesh.points = {{0, 0, 0},        {1, 0, 0},        {0, 1, 0},      {0.3, 0.3, 0.8},
                   {0.2, 0.3, -0.8}, {0.4, 0.2, -0.5}, {0.5, 0.5, 0.0}};
    mesh.cells = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}, {0, 1, 2, 6}};
    oracle::sampleField(mesh, Bump());
    const support::Reports reports;
    const TwinMesh twin = makeTwin(mesh, colorfulPoints(), 0.1);
    const auto bound = twin.node->getBound();
    EXPECT_LT(difference(twin, viewFrom(OBLIQUE, bound), "fan").rmse, 1e-5);
    EXPECT_LT(difference(twin, viewFrom({0.5, -1.0, -3.0}, bound), "fan2").rmse, 1e-5);
    for (const char* what : {"1 without volume", "1 faces of more than two"})
        EXPECT_EQ(reports.count(what), 1) << what;
}

TEST_F(MeshTest, UserValuesReachAShader)
{
    // Two fields, a pressure and a share, as colour and opacity: what colours of vertices show.
    oracle::TetraMesh mesh = jittered(6);
    for (const glm::dvec3& p : mesh.points)
        mesh.colors.emplace_back(p.x, 1.0 - p.x, 0.25, 0.3 * p.y);
    const TwinMesh twin = makeTwin(mesh, colorfulPoints(), 1.0);
    core::TetraSet set = oracle::tetraSet(mesh);
    const core::VertexArray places = set.vertices;
    set.vertices = core::VertexArray(core::VertexFormat::user(0, 0, 2));
    set.vertices.resize(mesh.points.size());
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        set.vertices.setPosition(i, places.position(i));
        double* user = set.vertices.record(i) + set.vertices.format().userOffset();
        user[0] = mesh.points[i].x;
        user[1] = 100.0 * mesh.points[i].y;
    }
    ASSERT_TRUE(twin.geometry->setTetraSet(std::move(set)).ok());
    const auto options = viewFrom(OBLIQUE, twin.node->getBound());
    const support::FloatImage without = support::renderScene(twin.node, options);
    EXPECT_EQ(support::coveredPixels(without).count(), 0u);
    const osg::ref_ptr<VolumeGeometry>& geometry = twin.geometry;
    // clang-format off
geometry->setFieldShader("vec4 shadeFields(vec4 color, float fields[FIELDS])\n"
                         "{ return vec4(fields[0], 1.0 - fields[0], 0.25, 0.003 * fields[1]); }\n");
    // clang-format on
    std::ifstream readme(OSGVOLUMIZER_SOURCE_DIR "/README.md");
    const std::string text{std::istreambuf_iterator<char>(readme), {}};
    std::ifstream source(OSGVOLUMIZER_SOURCE_DIR "/tests/render/MeshTest.cpp");
    const std::string own{std::istreambuf_iterator<char>(source), {}};
    const std::size_t begin = own.find("geometry->setFieldShader");
    EXPECT_NE(text.find(own.substr(begin, own.find("    // clang-format on") - begin)),
              std::string::npos);
    std::vector<double> periods, errors;
    for (const double period : {1.0, 0.5, 0.25}) {
        twin.node->setSamplingPeriod(osg::Vec3d(period, period, period) * 0.1);
        periods.push_back(period);
        errors.push_back(difference(twin, options, "fields").rmse);
    }
    EXPECT_LT(errors[0], 1e-4);
    EXPECT_LT(errors[2], errors[0]);
}

} // namespace MeshTest
