#include "TableFixture.h"

#include <osgVolumizer/core/accuracy/PeriodChoice.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace PeriodChoiceTest {

using namespace osgVolumizer::core;

namespace {

const Box3d BOX{glm::dvec3(0.0), glm::dvec3(32.0)};

double waves(const glm::dvec3& p)
{
    return 0.5 + 0.4 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y + 0.2 * p.z);
}

// What is interpolated linearly between samples at whole numbers, as voxels are.
double voxels(const glm::dvec3& p)
{
    const glm::dvec3 low = glm::min(glm::floor(p), glm::dvec3(31.0)), f = p - low;
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 step(i & 1, (i >> 1) & 1, i >> 2);
        const glm::dvec3 w = glm::mix(1.0 - f, f, step);
        sum += w.x * w.y * w.z * waves(low + step);
    }
    return sum;
}

PeriodChoice choose(const PeriodQuestion& question, const FractionField& field = voxels)
{
    return choosePeriod(question, field, BOX, glm::dmat3(1.0), false);
}

glm::dvec4 integrate(const CellRay& ray, const PeriodQuestion& q, RayRule rule, double period)
{
    switch (rule) {
    case RayRule::MIDPOINTS:
        return ray.integrate(q.midpoints, period, {});
    case RayRule::INTEGRALS:
        return ray.integrate(q.integrals, period, {});
    case RayRule::ADAPTIVE:
        return ray.integrateAdaptively(q.integrals, period, {});
    case RayRule::CELLS:
        break;
    }
    return ray.integrate(*q.table, period, {});
}

// Root mean square error over rays of our own: chords between random points of a sphere around the
// box are uniform lines.
double errorOf(const PeriodQuestion& q, const PeriodChoice& choice, double stretch)
{
    std::mt19937 random(99);
    std::normal_distribution<double> normal;
    const auto onSphere = [&]() {
        const glm::dvec3 direction(normal(random), normal(random), normal(random));
        return BOX.center() + 0.5 * glm::length(BOX.size()) * glm::normalize(direction);
    };
    double sum = 0.0;
    int rays = 0;
    while (rays < 1000) {
        const glm::dvec3 a = onSphere(), way = onSphere() - a;
        const glm::dvec3 s = (BOX.min - a) / way, t = (BOX.max - a) / way;
        const glm::dvec3 low = glm::min(s, t), high = glm::max(s, t);
        const double enter = std::max({low.x, low.y, low.z}),
                     leave = std::min({high.x, high.y, high.z});
        if (!(leave > enter)) continue;
        ++rays;
        const FractionField held = [](const glm::dvec3& p) {
            return voxels(glm::clamp(p, BOX.min, BOX.max));
        };
        const CellRay ray(RayPath{a + enter * way, a + leave * way}, held, nullptr, false);
        const glm::dvec4 light = integrate(ray, q, choice.rule, stretch * choice.periodVoxel);
        const glm::dvec4 d = light - ray.integrate(*q.exact, 0.1, {});
        sum += 0.25 * glm::dot(d, d);
    }
    return std::sqrt(sum / rays);
}

double square(double v)
{
    return 0.2 * v * v;
}

} // namespace

TEST(PeriodChoice, WhatIsUniformNeedsFewSamples)
{
    const TableForms table(opacityPoints(2, [](double) { return 0.05; }));
    const PeriodChoice choice = choose(table.question(1e-4), [](const glm::dvec3&) { return 0.5; });
    EXPECT_EQ(choice.periodVoxel, 8.0);
    EXPECT_EQ(choice.rule, RayRule::MIDPOINTS); // the cheapest
    EXPECT_LE(choice.error, 1e-5);
}

TEST(PeriodChoice, KeepsTheToleranceAndWastesLittle)
{
    const TableForms table(opacityPoints(65, square));
    for (const double tolerance : {4e-3, 1e-3, 2e-4}) {
        const PeriodQuestion q = table.question(tolerance);
        const PeriodChoice choice = choose(q);
        EXPECT_LE(choice.error, tolerance);
        EXPECT_LE(errorOf(q, choice, 1.0), tolerance);
        EXPECT_GT(errorOf(q, choice, 2.0), tolerance);
    }
}

TEST(PeriodChoice, FollowsTheOrderOfTheRule)
{
    // Errors of second order: a quarter of the tolerance takes half the period.
    const TableForms table(opacityPoints(65, square));
    PeriodQuestion q = table.question(1.6e-3);
    q.integrals = {};
    q.cells = false;
    const double period = choose(q).periodVoxel;
    q.tolerance = 4e-4;
    EXPECT_NEAR(choose(q).periodVoxel / period, 0.5, 0.12);
}

// Runs of values where the table jumps, and pieces of cells where runs would be too short.
TEST(PeriodChoice, TakesTheRuleThatTheTableNeeds)
{
    const TableForms table({{0.0, {1, 0.5, 0.25, 0.0}},
                            {0.5, {1, 0.5, 0.25, 0.0}},
                            {0.5, {1, 0.5, 0.25, 0.3}},
                            {0.6, {1, 0.5, 0.25, 0.3}},
                            {0.6, {1, 0.5, 0.25, 0.0}},
                            {1.0, {1, 0.5, 0.25, 0.0}}});
    PeriodQuestion q = table.question(1e-2);
    const PeriodChoice coarse = choose(q);
    EXPECT_TRUE(coarse.rule == RayRule::INTEGRALS || coarse.rule == RayRule::ADAPTIVE);
    EXPECT_LE(errorOf(q, coarse, 1.0), 1e-2);
    q.integrals = {};
    q.cells = false;
    const PeriodChoice midpoints = choose(q);
    EXPECT_EQ(midpoints.rule, RayRule::MIDPOINTS);
    EXPECT_LT(midpoints.periodVoxel, coarse.periodVoxel);
    q = table.question(1e-5);
    const PeriodChoice fine = choose(q);
    EXPECT_EQ(fine.rule, RayRule::CELLS);
    EXPECT_LE(fine.error, 1e-5);
    EXPECT_LE(errorOf(q, fine, 1.0), 1e-5);
}

// What cannot be kept is said, and what comes nearest is taken.
TEST(PeriodChoice, SaysWhatCannotBeKept)
{
    const TableForms table({{0.0, {1, 0.5, 0.25, 0.0}},
                            {0.5, {1, 0.5, 0.25, 0.0}},
                            {0.5, {1, 0.5, 0.25, 0.3}},
                            {1.0, {1, 0.5, 0.25, 0.3}}});
    PeriodQuestion q = table.question(1e-6);
    q.cells = false;
    const PeriodChoice choice = choose(q);
    EXPECT_GT(choice.error, 1e-6);
    EXPECT_LE(errorOf(q, choice, 1.0), choice.error);
}

TEST(PeriodChoice, LongerUnitsNeedNoMoreSamples)
{
    const TableForms table(opacityPoints(65, square));
    const PeriodQuestion q = table.question(1e-3);
    // The volume is thinner, and its errors smaller.
    EXPECT_GT(choosePeriod(q, voxels, BOX, glm::dmat3(0.1), false).periodVoxel,
              choose(q).periodVoxel);
}

TEST(PeriodChoice, IsRepeatable)
{
    const TableForms table(opacityPoints(65, square));
    const PeriodQuestion q = table.question(1e-3);
    const PeriodChoice a = choose(q), b = choose(q);
    EXPECT_EQ(a.periodVoxel, b.periodVoxel);
    EXPECT_EQ(a.error, b.error);
}

TEST(PeriodChoice, NothingToSeeNeedsNothing)
{
    const TableForms table(opacityPoints(2, [](double) { return 0.5; }));
    const PeriodQuestion q = table.question(1e-3);
    EXPECT_EQ(choose(q, [](const glm::dvec3&) { return double(NAN); }).periodVoxel, 8.0);
    EXPECT_EQ(choosePeriod(q, voxels, Box3d(), glm::dmat3(1.0), false).periodVoxel, 8.0);
}

} // namespace PeriodChoiceTest
