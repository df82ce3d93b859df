#include <oracles/ClosedForms.h>
#include <oracles/Grid.h>
#include <oracles/Ray.h>
#include <oracles/ScreenTriangles.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace SceneTest {

using namespace osgVolumizer;
using namespace osgVolumizer::oracle;

namespace {

Camera perspectiveCamera(int size = 32)
{
    Camera c;
    c.view = glm::lookAt(glm::dvec3(3, -4, 2), glm::dvec3(0.1, 0, 0), glm::dvec3(0, 0, 1));
    c.projection = glm::perspective(glm::radians(60.0), 1.0, 1.0, 100.0);
    c.width = c.height = size;
    return c;
}

Camera frontalCamera(int size = 32)
{
    Camera c;
    c.view = glm::lookAt(glm::dvec3(0, 0, 5), glm::dvec3(0.0), glm::dvec3(0, 1, 0));
    c.projection = glm::ortho(-1.5, 1.5, -1.5, 1.5, 1.0, 10.0);
    c.width = c.height = size;
    return c;
}

core::Box3d cube(double half)
{
    return {glm::dvec3(-half), glm::dvec3(half)};
}

double largest(const glm::dvec4& v)
{
    return std::max({std::abs(v.r), std::abs(v.g), std::abs(v.b), std::abs(v.a)});
}

std::array<glm::dvec3, 4> frontalQuad(double half, double z)
{
    return {glm::dvec3(-half, -half, z), glm::dvec3(half, -half, z), glm::dvec3(half, half, z),
            glm::dvec3(-half, half, z)};
}

} // namespace

TEST(Ray, GoesThroughThePixelInEveryProjection)
{
    Camera camera = perspectiveCamera();
    const glm::dmat4 projections[] = {camera.projection,
                                      glm::frustum(-0.2, 0.7, -0.5, 0.1, 0.5, 9.0),
                                      glm::ortho(-3.0, 1.0, -2.0, 2.0, -5.0, 9.0)};
    for (const glm::dmat4& projection : projections) {
        camera.projection = projection;
        const Ray ray = rayThrough(camera, 5.25, 20.75);
        EXPECT_DOUBLE_EQ(ray.direction.z, -1.0);
        for (const double depth : {0.7, 2.0, 50.0}) {
            const glm::dvec4 clip =
                projection * glm::dvec4(ray.origin + depth * ray.direction, 1.0);
            EXPECT_NEAR(16.0 * (clip.x / clip.w + 1.0), 5.25, 1e-11);
            EXPECT_NEAR(16.0 * (clip.y / clip.w + 1.0), 20.75, 1e-11);
        }
    }
}

TEST(Ray, TrianglesThatShareEdgesAreHitOnce)
{
    // A fan around a point that is a pixel centre, with edges through rows of pixel centres.
    Camera camera = frontalCamera(16);
    Scene scene;
    const glm::dvec3 corner[] = {{-1.5, -1.5, 0}, {1.5, -1.5, 0}, {1.5, 1.5, 0}, {-1.5, 1.5, 0}};
    const glm::dvec3 center(1.5 / 16, 1.5 / 16, 0);
    for (int i = 0; i < 4; ++i) {
        Triangle t;
        t.corner = {corner[i], corner[(i + 1) % 4], center};
        if (i == 2) std::swap(t.corner[0], t.corner[1]); // windings need not agree
        t.color = {glm::dvec4(0, 0, 0, 0.5), glm::dvec4(0, 0, 0, 0.5), glm::dvec4(0, 0, 0, 0.5)};
        scene.triangles.push_back(t);
    }
    const support::FloatImage image = render(scene, camera);
    for (const glm::vec4& p : image.pixels)
        EXPECT_EQ(p.a, 0.5f);
    camera = perspectiveCamera(64);
    for (const glm::vec4& p : render(scene, camera).pixels)
        EXPECT_TRUE(p.a == 0.5f || p.a == 0.0f);
}

TEST(Trace, ConstantBoxAgreesWithTheClosedForm)
{
    const glm::dvec4 color(0.9, 0.5, 0.1, 0.3);
    Scene scene;
    scene.volumes.push_back(
        boxVolume(std::make_shared<ConstantField>(0.5), cube(1.0), Table::constant(color), 0.7));
    for (const Camera& camera : {perspectiveCamera(), frontalCamera()}) {
        int covered = 0;
        for (int y = 0; y < camera.height; ++y)
            for (int x = 0; x < camera.width; ++x) {
                const Ray ray = rayThrough(camera, x + 0.5, y + 0.5);
                Crossing c;
                double length = 0.0;
                if (cross(ray, camera, scene.volumes[0], c))
                    length = (c.leave - c.enter) * glm::length(ray.direction);
                covered += length > 0.0;
                EXPECT_LT(largest(trace(scene, camera, x + 0.5, y + 0.5) -
                                  constantSegment(color, length / 0.7)),
                          1e-13);
            }
        EXPECT_GT(covered, 100);
    }
}

TEST(Trace, RampAgreesWithTheClosedForm)
{
    // Opacity rises along the ray from 0.1 to 0.9, also when the ramp is sampled on voxels.
    const RampField ramp({0, 0, -0.4}, 0.5);
    const Table table(
        {{0.0, glm::dvec4(0.2, 0.4, 0.6, 0.0)}, {1.0, glm::dvec4(0.2, 0.4, 0.6, 1.0)}});
    const glm::dvec4 expected = rampSegment({0.2, 0.4, 0.6}, 0.1, 0.9, 2.0 / 0.3);
    Scene scene;
    scene.volumes.push_back(boxVolume(std::make_shared<RampField>(ramp), cube(1.0), table, 0.3));
    EXPECT_LT(largest(trace(scene, frontalCamera(), 16.3, 12.1) - expected), 1e-10);

    glm::dmat4 toField = glm::translate(glm::dmat4(1.0), glm::dvec3(-1.0));
    toField = glm::scale(toField, glm::dvec3(2.0 / 7.0));
    const auto grid = std::make_shared<Grid>(glm::ivec3(8), ramp, toField);
    scene.volumes = {
        voxelVolume(grid, glm::ivec3(8), table, glm::dvec3(2.0 / 7.0), glm::dvec3(-1.0))};
    scene.volumes[0].unit = 0.3;
    EXPECT_LT(largest(trace(scene, frontalCamera(), 16.3, 12.1) - expected), 1e-10);
}

TEST(Trace, TightensWithItsToleranceAndAgreesWithBruteForce)
{
    glm::dmat4 toField = glm::translate(glm::dmat4(1.0), glm::dvec3(-1.0));
    toField = glm::scale(toField, glm::dvec3(2.0 / 31.0));
    const auto grid = std::make_shared<Grid>(glm::ivec3(32), MarschnerLobbField(), toField);
    // A jump, a kink, a saturated end.
    const Table table({{0.0, glm::dvec4(0.0)},
                       {0.4, glm::dvec4(1.0, 0.5, 0.0, 0.0)},
                       {0.5, glm::dvec4(0.3, 0.9, 0.0, 0.2)},
                       {0.5, glm::dvec4(0.0, 0.0, 1.0, 0.02)},
                       {1.0, glm::dvec4(1.0)}});
    Scene scene;
    scene.volumes = {
        voxelVolume(grid, glm::ivec3(32), table, glm::dvec3(2.0 / 31.0), glm::dvec3(-1.0))};
    const Camera camera = perspectiveCamera();
    double change = 0.0;
    for (int i = 0; i < 40; ++i) {
        const double x = 8.37 + 0.41 * i, y = 9.11 + 0.37 * i;
        scene.tolerance = 1e-11;
        const glm::dvec4 usual = trace(scene, camera, x, y);
        scene.tolerance = 1e-15;
        change = std::max(change, largest(usual - trace(scene, camera, x, y)));
    }
    EXPECT_LT(change, 1e-9);

    // Midpoint steps, from the definition alone.
    const Ray ray = rayThrough(camera, 15.9, 16.4);
    Crossing c;
    ASSERT_TRUE(cross(ray, camera, scene.volumes[0], c));
    const int steps = 2000000;
    const double h = (c.leave - c.enter) / steps;
    const double lengthUnits = h * c.objectLength / scene.volumes[0].unit;
    glm::dvec4 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const double t = c.enter + (i + 0.5) * h;
        const glm::dvec4 color = table.color(grid->value(c.fieldOrigin + t * c.fieldDirection));
        const double alpha = -std::expm1(-Table::extinction(color.a) * lengthUnits);
        sum += (1.0 - sum.a) * glm::dvec4(alpha * glm::dvec3(color), alpha);
    }
    EXPECT_GT(sum.a, 0.1);
    EXPECT_LT(largest(trace(scene, camera, 15.9, 16.4) - sum), 1e-6);
}

TEST(Trace, TrianglesAreCompositedWhereTheyAre)
{
    const glm::dvec4 fog(0.5, 0.6, 0.7, 0.4), glass(1.0, 0.2, 0.0, 0.25);
    Scene scene;
    scene.background = {0.1, 0.0, 0.0, 1.0};
    scene.volumes = {
        boxVolume(std::make_shared<ConstantField>(0.0), cube(1.0), Table::constant(fog))};
    scene.addQuad(frontalQuad(1.2, 0.5), glass);
    scene.addQuad(frontalQuad(1.2, 3.0), glass);
    scene.addQuad(frontalQuad(1.2, -0.25), {0.0, 1.0, 0.0, 1.0}, true);
    scene.addQuad(frontalQuad(1.2, -0.75), glass); // hidden
    const glm::dvec4 layer(glm::dvec3(glass) * glass.a, glass.a);
    glm::dvec4 expected = over(constantSegment(fog, 0.75), {0.0, 1.0, 0.0, 1.0});
    expected = over(layer, over(constantSegment(fog, 0.5), over(layer, expected)));
    EXPECT_LT(largest(trace(scene, frontalCamera(), 16.5, 16.5) - expected), 1e-13);
    EXPECT_LT(largest(trace(scene, frontalCamera(), 0.5, 0.5) - scene.background), 1e-15);
}

TEST(Trace, OverlappingVolumesAbsorbTogether)
{
    const glm::dvec4 a(1.0, 0.0, 0.0, 0.3), b(0.0, 0.0, 1.0, 0.6);
    Scene scene;
    scene.volumes = {
        boxVolume(std::make_shared<ConstantField>(0.0), cube(1.0), Table::constant(a)),
        boxVolume(std::make_shared<ConstantField>(0.0), cube(0.5), Table::constant(b))};
    const double ta = Table::extinction(a.a), tb = Table::extinction(b.a);
    const glm::dvec4 mixed((ta * glm::dvec3(a) + tb * glm::dvec3(b)) / (ta + tb),
                           -std::expm1(-(ta + tb)));
    const glm::dvec4 expected =
        over(constantSegment(a, 0.5), over(constantSegment(mixed, 1.0), constantSegment(a, 0.5)));
    const glm::dvec4 first = trace(scene, frontalCamera(), 16.5, 16.5);
    EXPECT_LT(largest(first - expected), 1e-12);
    std::swap(scene.volumes[0], scene.volumes[1]);
    EXPECT_LT(largest(first - trace(scene, frontalCamera(), 16.5, 16.5)), 1e-14);
}

TEST(Trace, TetrahedraTileTheirBox)
{
    const auto field = std::make_shared<GaussianField>(glm::dvec3(0.1, 0.2, 0.0), 0.4);
    const Table table(
        {{0.0, glm::dvec4(1.0, 0.0, 0.0, 0.0)}, {1.0, glm::dvec4(1.0, 1.0, 0.0, 0.8)}});
    Scene box, tetras;
    box.volumes = {boxVolume(field, cube(1.0), table)};
    const int corners[5][4] = {
        {0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}};
    for (const auto& t : corners) {
        std::array<glm::dvec3, 4> p;
        for (int i = 0; i < 4; ++i)
            p[i] = cube(1.0).corner(t[i]);
        Volume v = box.volumes[0];
        v.region = tetraRegion(p);
        v.objectToField = tetraMap(p, p);
        tetras.volumes.push_back(v);
    }
    const Camera camera = perspectiveCamera();
    for (int i = 0; i < 32; ++i)
        EXPECT_LT(largest(trace(box, camera, i + 0.5, 16.5) - trace(tetras, camera, i + 0.5, 16.5)),
                  1e-9);
    EXPECT_TRUE(tetraRegion({}).size() == 1 && tetraRegion({})[0].offset < 0.0);
}

TEST(Trace, TransformsAboveDoNotChangeThePicture)
{
    Scene scene;
    const auto field = std::make_shared<GaussianField>(glm::dvec3(0.1, 0.2, 0.0), 0.4);
    const Table table(
        {{0.0, glm::dvec4(1.0, 0.0, 0.0, 0.0)}, {1.0, glm::dvec4(1.0, 1.0, 0.0, 0.8)}});
    scene.volumes = {boxVolume(field, cube(1.0), table)};
    Camera camera = perspectiveCamera();
    const glm::dvec4 plain = trace(scene, camera, 15.2, 16.1);
    EXPECT_GT(plain.a, 0.1);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const glm::dmat4 moved = glm::scale(
            glm::translate(glm::dmat4(1.0), glm::dvec3(6.4e6 * scale)), glm::dvec3(scale));
        scene.volumes[0].objectToWorld = moved;
        Camera far = camera;
        far.view = camera.view * glm::inverse(moved);
        EXPECT_LT(largest(trace(scene, far, 15.2, 16.1) - plain), 1e-7) << scale;
    }
}

TEST(Trace, StartsAtTheEyeInsideTheVolume)
{
    const glm::dvec4 fog(0.5, 0.6, 0.7, 0.4);
    Scene scene;
    scene.volumes = {
        boxVolume(std::make_shared<ConstantField>(0.0), cube(1.0), Table::constant(fog))};
    Camera camera = perspectiveCamera();
    camera.view = glm::lookAt(glm::dvec3(0, 0, 0.25), glm::dvec3(0.0), glm::dvec3(0, 1, 0));
    EXPECT_LT(largest(trace(scene, camera, 16, 16) - constantSegment(fog, 1.25)), 1e-13);
    camera.projection = glm::ortho(-1.0, 1.0, -1.0, 1.0, 1.0, 2.0);
    camera.nearDepth = -std::numeric_limits<double>::infinity();
    EXPECT_LT(largest(trace(scene, camera, 16, 16) - constantSegment(fog, 2.0)), 1e-13);
}

TEST(Trace, SilhouettesAreFound)
{
    Scene scene;
    scene.addQuad(frontalQuad(0.75, 0.0), glm::dvec4(1.0));
    const support::FloatImage away = awayFromSilhouettes(scene, frontalCamera(16));
    // The rim of the square lies on the borders of pixels 4 and 11, its diagonal nowhere.
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const auto near = [](int p) { return p == 3 || p == 4 || p == 11 || p == 12; };
            const auto within = [](int p) { return p >= 3 && p <= 12; };
            const bool rim = (near(x) && within(y)) || (near(y) && within(x));
            EXPECT_EQ(away.at(x, y).a, rim ? 0.0f : 1.0f) << x << " " << y;
        }
}

TEST(ScreenTriangles, LeaveOutNothingThatARayHits)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-3.0, 3.0), size(0.01, 4.0), window(-8.0, 72.0);
    Scene scene;
    for (int i = 0; i < 400; ++i) {
        Triangle triangle;
        const glm::dvec3 center(place(random), place(random), place(random));
        const double s = size(random);
        for (glm::dvec3& corner : triangle.corner)
            corner = center + s * glm::dvec3(place(random), place(random), place(random));
        scene.triangles.push_back(triangle);
    }
    for (Camera camera : {perspectiveCamera(64), frontalCamera(64)}) {
        camera.nearDepth = 0.0; // triangles reach behind the eye
        const ScreenTriangles triangles(scene, camera);
        std::size_t listed = 0, hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const double x = window(random), y = window(random);
            const ScreenTriangles::List& list = triangles.at(x, y);
            const bool shown = x >= 0.0 && y >= 0.0 && x < 64.0 && y < 64.0;
            listed += shown ? list.size() : 0;
            for (const Triangle& triangle : scene.triangles) {
                Hit h;
                if (!hit(rayThrough(camera, x, y), camera, triangle, h)) continue;
                ++hits;
                EXPECT_TRUE(std::find(list.begin(), list.end(), &triangle) != list.end());
            }
        }
        EXPECT_GT(hits, 10000u);
        EXPECT_LT(listed, 2000u * 400u * 3 / 4);
    }
}

} // namespace SceneTest
