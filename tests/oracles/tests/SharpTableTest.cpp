// Tables with jumps and narrow peaks over noise, which no ray meets smoothly.

#include <oracles/ClosedForms.h>
#include <oracles/Ray.h>
#include <oracles/Roots.h>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace SharpTableTest {

using namespace osgVolumizer;
using namespace osgVolumizer::oracle;

namespace {

constexpr int SIZE = 24;

std::shared_ptr<Grid> noise()
{
    std::mt19937 random(5);
    std::vector<double> samples(std::size_t(SIZE) * SIZE * SIZE);
    for (double& s : samples)
        s = static_cast<double>(random()) * 0x1p-32;
    return std::make_shared<Grid>(glm::ivec3(SIZE), samples);
}

const Table jumps({{0.0, glm::dvec4(0.9, 0.5, 0.1, 0.0)},
                   {0.4, glm::dvec4(0.9, 0.5, 0.1, 0.0)},
                   {0.4, glm::dvec4(0.2, 0.7, 0.3, 0.6)},
                   {0.55, glm::dvec4(0.2, 0.7, 0.3, 0.6)},
                   {0.55, glm::dvec4(1.0, 0.1, 0.8, 0.01)},
                   {1.0, glm::dvec4(1.0, 0.1, 0.8, 0.01)}});

// Two, a hundredth of the range wide; of one colour each.
const Table peaks({{0.0, glm::dvec4(0.9, 0.5, 0.1, 0.0)},
                   {0.495, glm::dvec4(0.9, 0.5, 0.1, 0.0)},
                   {0.5, glm::dvec4(0.9, 0.5, 0.1, 0.9)},
                   {0.505, glm::dvec4(0.9, 0.5, 0.1, 0.0)},
                   {0.505, glm::dvec4(0.1, 0.4, 1.0, 0.0)},
                   {0.6, glm::dvec4(0.1, 0.4, 1.0, 0.0)},
                   {0.605, glm::dvec4(0.1, 0.4, 1.0, 0.3)},
                   {0.61, glm::dvec4(0.1, 0.4, 1.0, 0.0)},
                   {1.0, glm::dvec4(0.1, 0.4, 1.0, 0.0)}});

Scene sceneOf(const std::shared_ptr<const Grid>& grid, const Table& table)
{
    Scene scene;
    scene.volumes = {voxelVolume(grid, grid->size(), table)};
    return scene;
}

Camera obliqueCamera()
{
    Camera c;
    c.view = glm::lookAt(glm::dvec3(50, -30, 41), glm::dvec3(11.5), glm::dvec3(0, 0, 1));
    c.projection = glm::perspective(glm::radians(28.0), 1.0, 1.0, 200.0);
    c.width = c.height = 48;
    return c;
}

// Looks along -z; a pixel is a voxel.
Camera axisCamera()
{
    Camera c;
    c.view = glm::lookAt(glm::dvec3(12, 12, 100), glm::dvec3(12, 12, 0), glm::dvec3(0, 1, 0));
    c.projection = glm::ortho(-12.0, 12.0, -12.0, 12.0, 1.0, 200.0);
    c.width = c.height = SIZE;
    return c;
}

// A line through values a and b, one unit apart: its parts between points of a table whose colour
// is constant from each to the next have closed forms.
glm::dvec4 linearSegment(const Table& table, double a, double b)
{
    std::vector<double> places{0.0, 1.0};
    for (double knot : table.knots()) {
        const double f = (knot - a) / (b - a);
        if (f > 0.0 && f < 1.0) places.push_back(f);
    }
    std::sort(places.begin(), places.end());
    glm::dvec4 light(0.0);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const double h = places[i + 1] - places[i];
        if (h == 0.0) continue;
        // Opacity is linear between; what jumps at the ends is found from within.
        const auto at = [&](double f) { return table.color(a + (b - a) * (places[i] + f * h)); };
        const glm::dvec4 first = at(0.25), last = at(0.75);
        const double slope = 2.0 * (last.a - first.a);
        light = over(light, rampSegment(glm::dvec3(first), first.a - 0.25 * slope,
                                        last.a + 0.25 * slope, h));
    }
    return light;
}

double largest(const glm::dvec4& v)
{
    return std::max({std::abs(v.r), std::abs(v.g), std::abs(v.b), std::abs(v.a)});
}

// Midpoint steps, from the definition alone.
glm::dvec4 bruteForce(const Scene& scene, const Grid& grid, const Crossing& c, int steps)
{
    const Volume& volume = scene.volumes[0];
    const double h = (c.leave - c.enter) / steps;
    const double lengthUnits = h * c.objectLength / volume.unit;
    glm::dvec4 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const glm::dvec3 place = c.fieldOrigin + (c.enter + (i + 0.5) * h) * c.fieldDirection;
        const glm::dvec4 color = volume.table.color(grid.value(place));
        sum = over(sum, constantSegment(color, lengthUnits));
    }
    return sum;
}

} // namespace

TEST(SharpTables, AlongAnAxisHaveClosedForms)
{
    const auto grid = noise();
    for (const Table& table : {jumps, peaks}) {
        const Scene scene = sceneOf(grid, table);
        double shown = 0.0;
        for (int i = 0; i < SIZE * SIZE; ++i) {
            const double x = 0.3 + i % SIZE * 0.97, y = 0.2 + i / SIZE * 0.98;
            glm::dvec4 expected(0.0);
            for (int z = SIZE - 1; z > 0; --z)
                expected = over(expected, linearSegment(table, grid->value({x, y, z}),
                                                        grid->value({x, y, z - 1})));
            EXPECT_LT(largest(trace(scene, axisCamera(), x, y) - expected), 1e-10);
            shown = std::max(shown, expected.a);
        }
        EXPECT_GT(shown, 0.5);
    }
}

TEST(SharpTables, ChangeLittleWithTheTolerance)
{
    for (const Table& table : {jumps, peaks}) {
        Scene scene = sceneOf(noise(), table);
        for (const double tolerance : {1e-11, 1e-8}) {
            double change = 0.0, shown = 0.0;
            for (int i = 0; i < 200; ++i) {
                const double x = 10.37 + 0.131 * i, y = 9.11 + 0.147 * i;
                scene.tolerance = 1e-15;
                const glm::dvec4 exact = trace(scene, obliqueCamera(), x, y);
                scene.tolerance = tolerance;
                change = std::max(change, largest(trace(scene, obliqueCamera(), x, y) - exact));
                shown = std::max(shown, exact.a);
            }
            EXPECT_GT(shown, 0.5);
            EXPECT_LT(change, tolerance == 1e-8 ? 1e-7 : 1e-9);
        }
    }
}

TEST(SharpTables, AgreeWithBruteForce)
{
    const auto grid = noise();
    for (const Table& table : {jumps, peaks}) {
        const Scene scene = sceneOf(grid, table);
        for (int i = 0; i < 6; ++i) {
            const double x = 14.2 + 3.7 * i, y = 31.7 - 2.9 * i;
            Crossing c;
            ASSERT_TRUE(
                cross(rayThrough(obliqueCamera(), x, y), obliqueCamera(), scene.volumes[0], c));
            EXPECT_LT(
                largest(trace(scene, obliqueCamera(), x, y) - bruteForce(scene, *grid, c, 400000)),
                2e-5);
        }
    }
}

TEST(SharpTables, RootsOfRandomCubicsAreAllFound)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    int turning = 0;
    for (int i = 0; i < 20000; ++i) {
        double f[4];
        for (double& v : f)
            v = uniform(random);
        const std::vector<double> values{0.3, 0.5, 0.52};
        std::vector<double> roots;
        appendCubicRoots(f, values, 2.0, 5.0, roots);
        const auto cubic = [&](double t) {
            const double u = t - 2.0; // the nodes are 0, 1, 2 and 3
            return f[0] + u * (f[1] - f[0]) + u * (u - 1.0) / 2.0 * (f[2] - 2.0 * f[1] + f[0]) +
                   u * (u - 1.0) * (u - 2.0) / 6.0 * (f[3] - 3.0 * f[2] + 3.0 * f[1] - f[0]);
        };
        for (const double root : roots) {
            EXPECT_TRUE(root >= 2.0 && root <= 5.0);
            EXPECT_LT(std::min({std::abs(cubic(root) - 0.3), std::abs(cubic(root) - 0.5),
                                std::abs(cubic(root) - 0.52)}),
                      1e-13);
        }
        turning += roots.size() > 3;
        // Between neighbours among them the cubic crosses none of the values.
        roots.push_back(2.0);
        roots.push_back(5.0);
        std::sort(roots.begin(), roots.end());
        for (std::size_t n = 0; n + 1 < roots.size(); ++n) {
            if (roots[n + 1] - roots[n] < 1e-6) continue;
            const auto level = [&](double fraction) {
                const double v = cubic(roots[n] + fraction * (roots[n + 1] - roots[n]));
                return std::upper_bound(values.begin(), values.end(), v) - values.begin();
            };
            for (int k = 1; k < 8; ++k)
                EXPECT_EQ(level(k / 8.0), level(0.5));
        }
    }
    EXPECT_GT(turning, 1000);
}

} // namespace SharpTableTest
