// Rays cell by cell: closed forms, the order of the rule, and what corners of the table do to it.

#include "TableFixture.h"

#include <osgVolumizer/core/accuracy/CellRay.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace CellRayTest {

using namespace osgVolumizer::core;

namespace {

constexpr int SIZE = 12;

// Random samples at whole numbers, linearly between them.
class Noise
{
public:
    explicit Noise(unsigned seed)
    {
        std::mt19937 random(seed);
        for (double& v : _values)
            v = double(random()) / 4294967296.0;
    }
    double operator()(const glm::dvec3& position) const
    {
        const glm::dvec3 p = glm::clamp(position, glm::dvec3(0.0), glm::dvec3(SIZE - 1.0));
        const glm::dvec3 low = glm::min(glm::floor(p), glm::dvec3(SIZE - 2.0)), f = p - low;
        double sum = 0.0;
        for (int i = 0; i < 8; ++i) {
            const glm::ivec3 step(i & 1, (i >> 1) & 1, i >> 2), at = glm::ivec3(low) + step;
            const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(step));
            sum += w.x * w.y * w.z * _values[(at.z * SIZE + at.y) * SIZE + at.x];
        }
        return sum;
    }

private:
    double _values[SIZE * SIZE * SIZE];
};

std::vector<CellRay> raysThrough(const FractionField& field, bool nearest = false)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> inside(0.0, SIZE - 1.0);
    std::vector<CellRay> rays;
    for (int i = 0; i < 200; ++i) {
        glm::dvec3 a(inside(random), inside(random), inside(random));
        glm::dvec3 b(inside(random), inside(random), inside(random));
        a[i % 3] = 0.0;
        b[i % 3] = SIZE - 1.0;
        rays.emplace_back(RayPath{a, b}, field, nullptr, nearest);
    }
    return rays;
}

// As long as it is in units, between samples.
CellRay rayAlongX(double length, const FractionField& field)
{
    return CellRay(RayPath{{0.0, 0.5, 0.5}, {length, 0.5, 0.5}}, field, nullptr, false);
}

// Root mean square difference of what a rule makes of rays to the truth.
template <class Rule>
double errorOfRule(const std::vector<CellRay>& rays, const TableForms& forms, const Rule& rule)
{
    double sum = 0.0;
    for (const CellRay& ray : rays) {
        const glm::dvec4 d = rule(ray) - ray.integrate(forms.exact, 0.02, {});
        sum += 0.25 * glm::dot(d, d);
    }
    return std::sqrt(sum / double(rays.size()));
}

double errorOf(const std::vector<CellRay>& rays, const TableForms& forms, double longest)
{
    return errorOfRule(rays, forms,
                       [&](const CellRay& ray) { return ray.integrate(forms.table, longest, {}); });
}

std::size_t pieceCount(const CellRay& ray, const TableForms& forms, double longest)
{
    std::size_t count = 0;
    (void)ray.integrate(forms.table, longest, {0.0, nullptr, &count, {0.0, ray.lengthVoxel()}});
    return count;
}

} // namespace

// A ramp along the ray through a jump: what is opaque begins where the value passes it.
TEST(CellRay, FindsAJumpOfTheTable)
{
    const TableForms forms({{0.0, {1, 0, 0, 0.0}},
                            {0.37, {1, 0, 0, 0.0}},
                            {0.37, {0, 1, 0, 0.3}},
                            {1.0, {0, 1, 0, 0.3}}});
    const CellRay ray = rayAlongX(10.0, [](const glm::dvec3& p) { return p.x / 10.0; });
    const double opacity = 1.0 - std::pow(0.7, 6.3);
    const glm::dvec4 light = ray.integrate(forms.table, 100.0, {});
    EXPECT_NEAR(light.a, opacity, 1e-6); // samples are floats
    EXPECT_NEAR(light.g, opacity, 1e-6);
    EXPECT_EQ(light.r, 0.0);
    EXPECT_EQ(ray.cellCount(), 10u);
    EXPECT_EQ(pieceCount(ray, forms, 100.0), 11u);
    EXPECT_GE(pieceCount(ray, forms, 0.25), 40u);
    const glm::dvec2 part = ray.shownPart(forms.table);
    EXPECT_NEAR(part.x, 3.7, 1e-5);
    EXPECT_NEAR(part.y, 10.0, 1e-5);
}

// Colour and opacity that are linear along the ray: the integral of emission less what is absorbed
// in front of it, by many steps.
TEST(CellRay, IntegratesWhatIsAbsorbedWithinAPiece)
{
    for (const double opacity : {1e-6, 0.01, 0.5, 0.95}) {
        const TableForms forms({{0.0, {0.9, 0.1, 0.3, 0.0}}, {1.0, {0.2, 0.8, 0.3, opacity}}});
        const CellRay ray = rayAlongX(8.0, [](const glm::dvec3& p) { return p.x / 8.0; });
        glm::dvec3 color(0.0);
        double through = 1.0;
        constexpr int STEPS = 400000;
        for (int i = 0; i < STEPS; ++i) {
            const glm::dvec4 c = forms.function.evaluate((i + 0.5) / STEPS);
            const double next = through * std::pow(1.0 - c.a, 8.0 / STEPS);
            color += (through - next) * glm::dvec3(c);
            through = next;
        }
        const glm::dvec4 light = ray.integrate(forms.table, 100.0, {});
        EXPECT_NEAR(light.a, 1.0 - through, 1e-5 * (1.0 - through)) << opacity;
        EXPECT_LT(glm::length(glm::dvec3(light) - color), 1e-4 * glm::length(color)) << opacity;
    }
}

// Smooth tables: fourth order in the length of pieces, whatever faces and corners do to them.
TEST(CellRay, IsOfFourthOrder)
{
    const std::vector<CellRay> rays = raysThrough(Noise(3));
    const TableForms forms({{0.0, {0.9, 0.1, 0.3, 0.02}}, {1.0, {0.1, 0.8, 0.5, 0.3}}});
    const double coarse = errorOf(rays, forms, 0.6), fine = errorOf(rays, forms, 0.15);
    EXPECT_LT(coarse, 1e-4);
    EXPECT_GT(std::log2(coarse / fine) / 2.0, 3.3) << coarse << " " << fine;
}

// Jumps over white noise take nothing from that.
TEST(CellRay, KeepsItsOrderWithJumps)
{
    const std::vector<CellRay> rays = raysThrough(Noise(4));
    const TableForms forms({{0.0, {0.9, 0.1, 0.3, 0.05}},
                            {0.45, {0.9, 0.5, 0.3, 0.05}},
                            {0.45, {0.1, 0.8, 0.5, 0.3}},
                            {0.6, {0.1, 0.8, 0.5, 0.2}},
                            {0.6, {0.3, 0.1, 0.9, 0.0}},
                            {1.0, {0.3, 0.1, 0.9, 0.1}}});
    const double coarse = errorOf(rays, forms, 0.6), fine = errorOf(rays, forms, 0.15);
    EXPECT_LT(coarse, 2e-4);
    EXPECT_GT(std::log2(coarse / fine) / 2.0, 2.8) << coarse << " " << fine;
}

// Of the nearest sample a cell has one value, so that nothing is left to approximate.
TEST(CellRay, NearestSamplesAreExact)
{
    const Noise noise(6);
    const auto nearest = [&](const glm::dvec3& p) { return noise(glm::floor(p + 0.5)); };
    const std::vector<CellRay> rays = raysThrough(nearest, true);
    const TableForms forms({{0.0, {0.9, 0.1, 0.3, 0.0}},
                            {0.5, {0.9, 0.1, 0.3, 0.0}},
                            {0.6, {0.1, 0.8, 0.5, 0.4}},
                            {1.0, {0.3, 0.1, 0.9, 0.1}}});
    EXPECT_LT(errorOf(rays, forms, 100.0), 1e-6);
    // Equal steps see the same, less well.
    const glm::dvec4 steps = rays[0].integrate(forms.question(1.0).midpoints, 0.001, {});
    EXPECT_LT(glm::length(steps - rays[0].integrate(forms.table, 100.0, {})), 2e-3);
}

TEST(CellRay, HolesShowNothing)
{
    const TableForms forms({{0.0, {1, 1, 1, 0.5}}, {1.0, {1, 1, 1, 0.5}}});
    const CellRay ray = rayAlongX(10.0, [](const glm::dvec3& p) { return p.x < 3.0 ? NAN : 0.5; });
    EXPECT_NEAR(ray.integrate(forms.table, 100.0, {}).a, 1.0 - std::pow(0.5, 7.0), 1e-6);
}

TEST(CellRay, EndsWhereLittleIsLeft)
{
    const TableForms forms({{0.0, {1, 1, 1, 0.9}}, {1.0, {1, 1, 1, 0.9}}});
    const CellRay ray = rayAlongX(100.0, [](const glm::dvec3&) { return 0.5; });
    const double left = 1.0 - ray.integrate(forms.table, 100.0, {1e-3}).a;
    EXPECT_LE(left, 1e-3);
    EXPECT_GT(left, 1e-5);
}

// A table that is transparent, and nearly opaque beyond a kink, over smooth noise: for the same
// error steps that adapt are fewer, and both are of second order.
TEST(CellRay, StepsThatAdaptAreFewer)
{
    std::vector<CellRay> rays = raysThrough(Noise(8));
    const TableForms forms({{0.0, {0.9, 0.3, 0.3, 0.0}},
                            {0.2, {0.9, 0.3, 0.3, 0.0}},
                            {0.6, {0.8, 0.5, 0.3, 0.03}},
                            {0.8, {0.2, 0.8, 0.5, 0.9}},
                            {1.0, {0.3, 0.1, 0.9, 0.9}}});
    const PeriodQuestion q = forms.question(1e-3);
    std::size_t tried = 0;
    const auto adaptive = [&](double period) {
        tried = 0;
        return errorOfRule(rays, forms, [&](const CellRay& ray) {
            return ray.integrateAdaptively(q.integrals, period,
                                           {0.0, nullptr, &tried, {0.0, ray.lengthVoxel()}});
        });
    };
    const double coarse = adaptive(0.2), fine = adaptive(0.05);
    EXPECT_NEAR(std::log2(coarse / fine) / 2.0, 2.0, 0.3) << coarse << " " << fine;
    const std::size_t fewer = tried;
    std::size_t equal = 0;
    double period = 0.1;
    for (double error = 1.0; error > fine; period *= 0.9) {
        equal = 0;
        error = errorOfRule(rays, forms, [&](const CellRay& ray) {
            return ray.integrate(q.integrals, period,
                                 {0.0, nullptr, &equal, {0.0, ray.lengthVoxel()}});
        });
    }
    EXPECT_LT(1.3 * double(fewer), double(equal));
}

// By hand: a plane that is lit head on, at an angle, and from behind, and one that has no normal.
TEST(CellRay, IsLitAsTheRendererDoesIt)
{
    const RayShading shading{0.2, 0.8, 0.3, 32.0};
    const glm::dvec3 color(0.5, 0.25, 1.0), eye(0.0, 0.0, 1.0);
    const auto expect = [&](const glm::dvec3& gradient, const glm::dvec3& light, double diffuse,
                            double highlight) {
        const glm::dvec3 made = shading.shade(color, gradient, light, eye);
        EXPECT_LT(glm::length(made - (color * (0.2 + 0.8 * diffuse) + 0.3 * highlight)), 1e-6);
    };
    expect({0.0, 0.0, 3.0}, eye, 1.0, 1.0);
    expect({0.0, 0.0, -3.0}, eye, 1.0, 1.0);
    expect({0.0, 3.0, 3.0}, eye, std::sqrt(0.5), std::pow(0.5, 16.0));
    expect({0.0, 0.0, 3.0}, {0.0, 0.6, 0.8}, 0.8, std::pow(0.9, 16.0)); // half way: cos^2 = 0.9
    expect({0.0, 0.0, 0.0}, eye, 0.0, 0.0);
}

// Gradients are taken to the frame of units, whatever its scale; a lit ray converges.
TEST(CellRay, LitRaysConverge)
{
    const Noise noise(9);
    const auto gradient = [&](const glm::dvec3& p) {
        glm::dvec3 g;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0.0);
            step[axis] = 1.0;
            g[axis] = 0.5 * (noise(p + step) - noise(p - step));
        }
        return g;
    };
    const TableForms forms({{0.0, {0.9, 0.1, 0.3, 0.02}}, {1.0, {0.1, 0.8, 0.5, 0.3}}});
    const RayShading shading;
    const RayIntegration lit{0.0, &shading};
    double coarse = 0.0, fine = 0.0;
    for (int i = 0; i < 60; ++i) {
        RayPath path{{0.0, 2.0 + 0.1 * i, 3.0 + 0.07 * i}, {SIZE - 1.0, 8.0 - 0.1 * i, 5.0}};
        path.voxelToUnits = glm::dmat3(2.0);
        path.toLight = glm::normalize(glm::dvec3(-1.0, 0.3, 0.5));
        const CellRay ray(path, noise, gradient, false);
        const glm::dvec4 truth = ray.integrate(forms.exact, 1.0 / 128.0, lit);
        coarse += glm::length(ray.integrate(forms.table, 0.125, lit) - truth);
        fine += glm::length(ray.integrate(forms.table, 0.03125, lit) - truth);
    }
    // Highlights are narrow, and normals turn quickly where there is hardly a gradient.
    EXPECT_LT(coarse / 60.0, 1e-3);
    EXPECT_LT(fine / 60.0, 5e-5);
}

} // namespace CellRayTest
