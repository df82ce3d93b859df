#include "ExtinctionTexels.h"

#include <osgVolumizer/core/accuracy/PeriodChoice.h>
#include <osgVolumizer/core/accuracy/RaySamples.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace PeriodChoiceTest {

using namespace osgVolumizer::core;

namespace {

constexpr int TABLE_SIZE = 16384;

std::vector<glm::vec4> makeTable(const std::function<double(double)>& extinctionBits)
{
    return extinctionTexels(TABLE_SIZE, {1.0f, 0.5f, 0.25f}, extinctionBits);
}

PeriodQuestion question(const std::vector<glm::vec4>& texels, double tolerance)
{
    PeriodQuestion q;
    q.tolerance = tolerance;
    q.midpoints = {texels.data(), TABLE_SIZE, false};
    q.integrals = {texels.data(), TABLE_SIZE, true};
    q.box = {glm::dvec3(0.0), glm::dvec3(32.0)};
    return q;
}

double waves(const glm::dvec3& p)
{
    return 0.5 + 0.4 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y + 0.2 * p.z);
}

// The part of a line in the box, as two points; false where it misses.
bool clip(const Box3d& box, glm::dvec3& a, glm::dvec3& b)
{
    const glm::dvec3 from = a, way = b - a;
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = (box.min[axis] - from[axis]) / way[axis];
        const double high = (box.max[axis] - from[axis]) / way[axis];
        enter = std::max(enter, std::min(low, high));
        leave = std::min(leave, std::max(low, high));
    }
    a = from + enter * way;
    b = from + leave * way;
    return enter < leave;
}

// Error of a period over rays of our own: chords between random points of a sphere around the box
// are uniform lines.
double errorOf(const FractionField& field, const PeriodQuestion& q, const PeriodChoice& choice,
               double stretch)
{
    constexpr int SAMPLES_PER_VOXEL = 24;
    std::mt19937 random(99);
    std::normal_distribution<double> normal;
    const auto onSphere = [&]() {
        const glm::dvec3 direction(normal(random), normal(random), normal(random));
        return q.box.center() + 0.5 * glm::length(q.box.size()) * glm::normalize(direction);
    };
    const ExtinctionTable& table = choice.integrals ? q.integrals : q.midpoints;
    double sum = 0.0;
    int rays = 0;
    while (rays < 1000) {
        glm::dvec3 a = onSphere(), b = onSphere();
        if (!clip(q.box, a, b)) continue;
        ++rays;
        const int intervals = std::max(int(glm::length(b - a) * SAMPLES_PER_VOXEL), 2);
        RaySamples samples;
        samples.unitsPerInterval = glm::length(b - a) / intervals;
        for (int k = 0; k <= intervals; ++k)
            samples.values.push_back(float(field(a + (b - a) * (double(k) / intervals))));
        const glm::dvec4 d =
            samples.integrate(table, stretch * choice.periodVoxel * SAMPLES_PER_VOXEL) -
            samples.integrate(q.midpoints, 1.0);
        sum += 0.25 * glm::dot(d, d);
    }
    return std::sqrt(sum / rays);
}

} // namespace

TEST(PeriodChoice, WhatIsUniformNeedsOneSample)
{
    const auto texels = makeTable([](double) { return 0.05; });
    const PeriodChoice choice =
        choosePeriod([](const glm::dvec3&) { return 0.5; }, question(texels, 1e-4));
    EXPECT_EQ(choice.periodVoxel, 16.0);
    EXPECT_FALSE(choice.integrals); // the cheaper table
    EXPECT_LE(choice.error, 1e-7);
}

TEST(PeriodChoice, KeepsTheToleranceAndWastesLittle)
{
    const auto texels = makeTable([](double v) { return 0.3 * v * v; });
    for (const double tolerance : {4e-3, 1e-3, 2e-4}) {
        const PeriodQuestion q = question(texels, tolerance);
        const PeriodChoice choice = choosePeriod(waves, q);
        EXPECT_LE(choice.error, tolerance);
        EXPECT_LE(errorOf(waves, q, choice, 1.0), tolerance);
        EXPECT_GT(errorOf(waves, q, choice, 1.6), tolerance);
    }
}

TEST(PeriodChoice, FollowsTheOrderOfTheRule)
{
    // Errors of second order: a quarter of the tolerance takes half the period.
    const auto texels = makeTable([](double v) { return 0.3 * v * v; });
    PeriodQuestion q = question(texels, 1.6e-3);
    q.integrals = {};
    const double period = choosePeriod(waves, q).periodVoxel;
    q.tolerance = 4e-4;
    EXPECT_NEAR(choosePeriod(waves, q).periodVoxel / period, 0.5, 0.1);
}

TEST(PeriodChoice, TakesIntegralsWhereTheTableJumps)
{
    const auto texels = makeTable([](double v) { return v > 0.5 && v < 0.6 ? 0.5 : 0.0; });
    const PeriodQuestion q = question(texels, 4e-3);
    const PeriodChoice choice = choosePeriod(waves, q);
    EXPECT_TRUE(choice.integrals);
    PeriodQuestion without = q;
    without.integrals = {};
    const PeriodChoice midpoints = choosePeriod(waves, without);
    EXPECT_FALSE(midpoints.integrals);
    EXPECT_LT(midpoints.periodVoxel, choice.periodVoxel);
}

TEST(PeriodChoice, LongerUnitsNeedNoMoreSamples)
{
    const auto texels = makeTable([](double v) { return 0.3 * v * v; });
    PeriodQuestion q = question(texels, 1e-3);
    const double period = choosePeriod(waves, q).periodVoxel;
    q.voxelToUnits = glm::dmat3(0.1); // the volume is thinner, and its errors smaller
    EXPECT_GT(choosePeriod(waves, q).periodVoxel, period);
}

TEST(PeriodChoice, IsRepeatable)
{
    const auto texels = makeTable([](double v) { return 0.3 * v * v; });
    const PeriodQuestion q = question(texels, 1e-3);
    const PeriodChoice a = choosePeriod(waves, q), b = choosePeriod(waves, q);
    EXPECT_EQ(a.periodVoxel, b.periodVoxel);
    EXPECT_EQ(a.error, b.error);
}

TEST(PeriodChoice, NothingToSeeNeedsNothing)
{
    const auto texels = makeTable([](double) { return 1.0; });
    PeriodQuestion q = question(texels, 1e-3);
    EXPECT_EQ(choosePeriod([](const glm::dvec3&) { return double(NAN); }, q).periodVoxel, 16.0);
    q.box = Box3d();
    EXPECT_EQ(choosePeriod(waves, q).periodVoxel, 1.0);
}

} // namespace PeriodChoiceTest
