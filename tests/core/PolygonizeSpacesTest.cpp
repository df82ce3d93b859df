// Modes, spaces, bounds and refusals of polygonize().

#include "TestGeometry.h"
#include "osgVolumizer/core/sampling/SurfaceFamily.h"
#include "osgVolumizer/core/sampling/ViewHelpers.h"

#include <gtest/gtest.h>

#include <limits>

namespace PolygonizeSpacesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

namespace {

double sumOfAreas(const PolygonizedFaces& out)
{
    double a = 0.0;
    for (const FaceRange& r : out.ranges)
        a += area(out.faces, r);
    return a;
}

/// Every face looks towards the eye: counter-clockwise from far to near.
void expectFacing(const PolygonizedFaces& out, const glm::dvec3& towardsEye, double tolerance)
{
    for (const FaceRange& r : out.ranges) {
        glm::dvec3 n(0.0);
        const double a = area(out.faces, r, &n);
        EXPECT_NEAR(glm::dot(n, towardsEye), a, tolerance * a + 1e-6);
    }
}

} // namespace

TEST(PolygonizeSpaces, PeriodCountsVoxelsAlongTheViewPerAxis)
{
    // Voxels of 1 x 2 x 4 units: the box is 64 x 32 x 16 of them.
    const TetraSet box = makeBox(glm::dvec3(0.0), glm::dvec3(64.0));
    SamplingParameters p;
    p.voxelSize = {1, 2, 4};
    PolygonizedFaces out;
    ASSERT_TRUE(polygonize(box, {}, viewAlong({1, 0, 0}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 64);
    ASSERT_TRUE(polygonize(box, {}, viewAlong({0, 1, 0}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 32);
    ASSERT_TRUE(polygonize(box, {}, viewAlong({0, 0, -1}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 16);
    p.periodVoxel = {1, 1, 0.25};
    ASSERT_TRUE(polygonize(box, {}, viewAlong({0, 0, -1}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 64);
    // A model scaled by s has depths scaled by s, and as many surfaces.
    for (const double s : {1e-6, 1e6}) {
        View v = viewAlong({1, 2, 3});
        ASSERT_TRUE(polygonize(box, {}, v, p, out).ok());
        const int count = out.surfaceCount;
        const double spacing = out.spacing;
        v.toEye = glm::scale(glm::dmat4(1.0), glm::dvec3(s)) * v.toEye;
        ASSERT_TRUE(polygonize(box, {}, v, p, out).ok());
        EXPECT_EQ(out.surfaceCount, count);
        EXPECT_NEAR(out.spacing, spacing * s, 1e-9 * spacing * s);
    }
}

TEST(PolygonizeSpaces, DepthsDescendAndAreThoseOfTheFaces)
{
    const TetraSet grid = makeGrid(3, 6.0);
    for (const auto mode : {SamplingMode::VIEWPORT_ALIGNED, SamplingMode::SPHERICAL}) {
        SamplingParameters p;
        p.mode = mode;
        p.periodVoxel = glm::dvec3(0.5);
        const View view = viewAlong({3, -2, 1});
        PolygonizedFaces out;
        ASSERT_TRUE(polygonize(grid, {}, view, p, out).ok());
        for (int s = 0; s < out.surfaceCount; ++s) {
            const double depth = out.surfaceDepths[std::size_t(s)];
            if (s > 0) {
                EXPECT_LT(depth, out.surfaceDepths[std::size_t(s) - 1]);
            }
            const FaceRange& r = out.range(s, 0);
            for (std::uint32_t i = r.firstIndex; i < r.firstIndex + r.indexCount; ++i) {
                const glm::dvec3 eye = glm::dvec3(
                    view.toEye * glm::dvec4(out.faces.position(out.faces.indices[i]), 1.0));
                EXPECT_NEAR(mode == SamplingMode::SPHERICAL ? glm::length(eye) : -eye.z, depth,
                            mode == SamplingMode::SPHERICAL ? 0.1 * out.spacing : 1e-5);
            }
        }
        expectFacing(out,
                     mode == SamplingMode::SPHERICAL ? -glm::normalize(glm::dvec3(3, -2, 1))
                                                     : -glm::normalize(view.depthGradient()),
                     mode == SamplingMode::SPHERICAL ? 1e-3 : 1e-5);
        if (mode == SamplingMode::SPHERICAL) continue;
        // A mirrored model keeps the rule in its own frame.
        View mirrored = view;
        mirrored.toEye = mirrored.toEye * glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1));
        ASSERT_TRUE(polygonize(grid, {}, mirrored, p, out).ok());
        expectFacing(out, -glm::normalize(mirrored.depthGradient()), 1e-5);
    }
}

TEST(PolygonizeSpaces, ViewVolumeSurfacesDoNotDependOnTheObject)
{
    SamplingParameters p;
    p.space = SamplingSpace::VIEW_VOLUME;
    View view = viewAlong({1, 2, 3});
    PolygonizedFaces a, b;
    ASSERT_TRUE(polygonize(makeBox({-3, -3, -3}, {4, 4, 4}), {}, view, p, a).ok());
    ASSERT_TRUE(polygonize(makeBox({-1.37, 0.1, 0}, {5, 3, 9}), {}, view, p, b).ok());
    EXPECT_EQ(a.spacing, b.spacing);
    int shared = 0;
    for (const double da : a.surfaceDepths)
        for (const double db : b.surfaceDepths)
            shared += std::abs(da - db) < 1e-9 ? 1 : 0;
    EXPECT_GT(shared, 5);
    for (const double d : a.surfaceDepths) {
        const double layer = (1000.0 - d) / a.spacing - 0.5;
        EXPECT_NEAR(layer, std::round(layer), 1e-9);
    }
    // Nothing behind the eye or beyond far, and a bound that makes the spacing grow.
    p.maximumSamples = 50;
    ASSERT_TRUE(polygonize(makeBox(glm::dvec3(-600.0), glm::dvec3(600.0)), {}, view, p, a).ok());
    EXPECT_LE(a.surfaceCount, 50);
    EXPECT_NEAR(a.spacing, 999.0 / 50.0, 1e-9);
    for (const double d : a.surfaceDepths)
        EXPECT_TRUE(d > 1.0 && d < 1000.0);
    // An infinite far plane.
    view.projection = glm::infinitePerspective(1.0, 1.0, 1.0);
    p.maximumSamples = 4096;
    ASSERT_TRUE(polygonize(makeBox({-3, -3, -3}, {4, 4, 4}), {}, view, p, a).ok());
    EXPECT_NEAR(sumOfAreas(a) * a.spacing, 343.0, 3.0);
}

TEST(PolygonizeSpaces, PrimitiveGivesEveryTetrahedronItsOwnLayers)
{
    SamplingParameters p;
    p.space = SamplingSpace::PRIMITIVE;
    p.periodVoxel = glm::dvec3(0.05);
    PolygonizedFaces out;
    ASSERT_TRUE(polygonize(makeGrid(2, 3.0), {}, viewAlong({1, 2, 3}), p, out).ok());
    ASSERT_EQ(out.faceSpacings.size(), out.faces.faceCount());
    double volume = 0.0;
    for (std::uint32_t f = 0; f < out.faces.faceCount(); ++f)
        volume += out.faceSpacings[f] * area(out.faces, {f, 1, out.faces.faceOffsets[f], 0});
    EXPECT_NEAR(volume, 27.0, 0.05);
    for (const float s : out.faceSpacings)
        EXPECT_LE(s, out.spacing * 1.0001);
    // Small tetrahedra in a coarse lattice: one face each all the same.
    p.periodVoxel = glm::dvec3(10.0);
    ASSERT_TRUE(polygonize(makeGrid(2, 3.0), {}, viewAlong({1, 2, 3}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 1);
    EXPECT_EQ(out.faces.faceCount(), 40u);
}

TEST(PolygonizeSpaces, PiecesOfATetrahedronShareItsLayers)
{
    // Spheres: tetrahedra are refined, but each counts as one for PRIMITIVE. Its faces then are a
    // midpoint rule for its volume, of second order, however many pieces it has.
    SamplingParameters p;
    p.space = SamplingSpace::PRIMITIVE;
    p.mode = SamplingMode::SPHERICAL;
    p.curvedTolerance = 0.002;
    View view;
    view.toEye = glm::lookAt(glm::dvec3(-1, -2, -3), glm::dvec3(2, 2, 2), glm::dvec3(0, 0, 1));
    view.projection = glm::perspective(1.0, 1.0, 0.1, 100.0);
    TetraSet one;
    one.vertices.resize(4);
    one.vertices.setPosition(0, {0, 0, 0});
    one.vertices.setPosition(1, {6, 1, 0});
    one.vertices.setPosition(2, {1, 6, 1});
    one.vertices.setPosition(3, {0, 1, 6});
    one.indices = {0, 1, 2, 3};
    const double volume = glm::determinant(glm::dmat3(6, 1, 0, 1, 6, 1, 0, 1, 6)) / 6.0;
    double errors[3];
    for (int i = 0; i < 3; ++i) {
        p.periodVoxel = glm::dvec3(1.0 / (1 << i));
        PolygonizedFaces out;
        ASSERT_TRUE(polygonize(one, {}, view, p, out).ok());
        double sum = 0.0;
        for (std::uint32_t f = 0; f < out.faces.faceCount(); ++f) {
            EXPECT_EQ(out.faceSpacings[f], out.faceSpacings[0]);
            sum += out.faceSpacings[f] * area(out.faces, {f, 1, out.faces.faceOffsets[f], 0});
        }
        errors[i] = std::abs(sum - volume);
    }
    EXPECT_GE(std::log2(errors[0] / errors[2]) / 2.0, 1.8)
        << errors[0] << " " << errors[1] << " " << errors[2];
}

TEST(PolygonizeSpaces, AxisAlignedPlanesAreVoxelPlanesAlsoInBentTetrahedra)
{
    TetraSet set = makeGrid(3, 6.0, VertexFormat(VertexLayout::T3F_V3F));
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
        const glm::dvec3 p = set.vertices.position(i);
        set.vertices.setVoxelCoordinate(i, p * 2.0 + glm::dvec3(0, 0, 0.3 * std::sin(p.x)));
    }
    SamplingParameters p;
    p.mode = SamplingMode::AXIS_ALIGNED;
    p.voxelSize = glm::dvec3(0.5);
    p.periodVoxel = glm::dvec3(0.1);
    PolygonizedFaces out;
    ASSERT_TRUE(polygonize(set, {}, viewAlong({0.1, 0.2, -1}), p, out).ok());
    EXPECT_EQ(out.axis, 2);
    for (int s = 0; s < out.surfaceCount; ++s) {
        if (s > 0) {
            EXPECT_GT(out.surfaceDepths[std::size_t(s)], out.surfaceDepths[std::size_t(s) - 1]);
        }
        const FaceRange& r = out.range(s, 0);
        for (std::uint32_t i = r.firstIndex; i < r.firstIndex + r.indexCount; ++i)
            EXPECT_NEAR(out.faces.record(out.faces.indices[i])[2],
                        out.surfaceDepths[std::size_t(s)], 1e-5);
    }
    // Bent faces: what counts is their projection along z.
    glm::dvec3 normal(0.0);
    for (const FaceRange& r : out.ranges)
        area(out.faces, r, &normal);
    EXPECT_NEAR(normal.z * out.spacing * 0.5, 216.0, 0.5);
}

TEST(PolygonizeSpaces, AxisAlignedFromInsideIsOrderedByDistance)
{
    SamplingParameters p;
    p.mode = SamplingMode::AXIS_ALIGNED;
    View view;
    view.projection = glm::perspective(1.0, 1.0, 0.1, 100.0);
    view.toEye = glm::lookAt(glm::dvec3(3.2, 4.0, 2.6), glm::dvec3(4, 4.1, 9), {0, 1, 0});
    PolygonizedFaces out;
    ASSERT_TRUE(polygonize(makeBox(glm::dvec3(0.0), glm::dvec3(8.0)), {}, view, p, out).ok());
    ASSERT_EQ(out.surfaceCount, 8);
    for (int s = 1; s < 8; ++s)
        EXPECT_LT(std::abs(out.surfaceDepths[std::size_t(s)] - 2.6),
                  std::abs(out.surfaceDepths[std::size_t(s) - 1] - 2.6));
    for (int s = 0; s < 8; ++s) {
        EXPECT_NEAR(area(out.faces, out.range(s, 0)), 64.0, 1e-4);
        EXPECT_EQ(out.faces.position(out.faces.indices[out.range(s, 0).firstIndex]).z,
                  out.surfaceDepths[std::size_t(s)]);
    }
}

TEST(PolygonizeSpaces, CullingDropsWhatTheViewCannotShow)
{
    const auto grid = std::make_shared<TetraSet>(makeGrid(24, 24.0));
    Polygonizer polygonizer;
    ASSERT_TRUE(polygonizer.setTetraSet(grid).ok());
    View view; // from the middle, looking along z
    view.projection = glm::perspective(0.6, 1.0, 0.1, 100.0);
    view.toEye = glm::lookAt(glm::dvec3(12.1, 12.2, 12.3), glm::dvec3(12.1, 12.2, 20.0), {0, 1, 0});
    SamplingParameters p;
    PolygonizedFaces all, culled;
    ASSERT_TRUE(polygonizer.polygonize(view, p, all).ok());
    p.cullToView = true;
    ASSERT_TRUE(polygonizer.polygonize(view, p, culled).ok());
    EXPECT_EQ(all.surfaceCount, culled.surfaceCount);
    EXPECT_LT(culled.faces.faceCount() * 3, all.faces.faceCount());
    // Inside the view nothing is missing: areas weighted with a bump that is zero outside agree.
    const auto visibleArea = [&](const PolygonizedFaces& f) {
        double sum = 0.0;
        for (std::uint32_t i = 0; i < f.faces.faceCount(); ++i) {
            const std::uint32_t first = f.faces.faceOffsets[i];
            const glm::dvec4 clip = view.projection * view.toEye *
                                    glm::dvec4(f.faces.position(f.faces.indices[first]), 1.0);
            if (clip.w > 0.0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w)
                sum += area(f.faces, {i, 1, first, 0});
        }
        return sum;
    };
    EXPECT_GT(visibleArea(all), 10.0);
    EXPECT_NEAR(visibleArea(culled), visibleArea(all), 1e-9 * visibleArea(all));
}

TEST(PolygonizeSpaces, RefusalsNameTheFieldAndLeaveTheOutputAlone)
{
    const TetraSet box = makeBox(glm::dvec3(0.0), glm::dvec3(4.0));
    const View view = viewAlong({1, 2, 3});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    PolygonizedFaces out;
    ASSERT_TRUE(polygonize(box, {}, view, SamplingParameters(), out).ok());
    const std::vector<float> before = out.faces.vertices;
    const auto expect = [&](ErrorCode code, const TetraSet& set, const std::vector<Box3d>& boxes,
                            const View& v, const SamplingParameters& p, const char* word) {
        const Status s = polygonize(set, boxes, v, p, out);
        EXPECT_EQ(s.code, code) << s.text;
        EXPECT_NE(s.text.find(word), std::string::npos) << s.text;
        EXPECT_EQ(out.faces.vertices, before);
    };
    for (const double period : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        SamplingParameters p;
        p.periodVoxel.y = period;
        expect(ErrorCode::VALUE_INVALID, box, {}, view, p, "periodVoxel");
        p = {};
        p.voxelSize.z = period;
        expect(ErrorCode::VALUE_INVALID, box, {}, view, p, "voxelSize");
    }
    SamplingParameters p;
    p.maximumSamples = 0;
    expect(ErrorCode::VALUE_INVALID, box, {}, view, p, "maximumSamples");
    p = {};
    p.mode = static_cast<SamplingMode>(7);
    expect(ErrorCode::VALUE_INVALID, box, {}, view, p, "mode");
    p = {};
    p.outputOrigin.x = nan;
    expect(ErrorCode::VALUE_INVALID, box, {}, view, p, "outputOrigin");
    p = {};
    expect(ErrorCode::VALUE_INVALID, box, {{{0, 0, 0}, {1, 1, 1}}, {{0, 2, 0}, {1, 1, 1}}}, view, p,
           "box 1");
    TetraSet bad = box;
    bad.vertices.setPosition(5, {0, nan, 0});
    expect(ErrorCode::VALUE_INVALID, bad, {}, view, p, "vertex 5");
    View flat = view;
    flat.toEye[1] = flat.toEye[0];
    expect(ErrorCode::SINGULAR_MATRIX, box, {}, flat, p, "model-view");
    View blind = view;
    blind.projection = glm::dmat4(0.0);
    expect(ErrorCode::SINGULAR_MATRIX, box, {}, blind, p, "projection");
    // 2^13 surfaces times 2^12 bricks.
    std::vector<Box3d> boxes(4097, Box3d{{0, 0, 0}, {1, 1, 1}});
    p.periodVoxel = glm::dvec3(1e-6);
    p.maximumSamples = 1 << 13;
    expect(ErrorCode::TOO_LARGE, box, boxes, view, p, "bricks");
    p.maximumSamples = std::numeric_limits<int>::max();
    p.periodVoxel = glm::dvec3(1e-12);
    expect(ErrorCode::TOO_LARGE, box, {}, view, p, "surfaces");
    View tiny = view;
    tiny.toEye = glm::scale(glm::dmat4(1.0), glm::dvec3(1e-310)) * tiny.toEye;
    p = {};
    p.mode = SamplingMode::VIEWPORT_ALIGNED;
    EXPECT_FALSE(polygonize(box, {}, tiny, p, out).ok());
    EXPECT_EQ(out.faces.vertices, before);
    // Spheres finer than memory.
    p = {};
    p.mode = SamplingMode::SPHERICAL;
    p.curvedTolerance = 1e-14;
    expect(ErrorCode::TOO_LARGE, box, {}, view, p, "tetrahedra");
}

} // namespace PolygonizeSpacesTest
