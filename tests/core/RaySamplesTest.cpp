#include "ExtinctionTexels.h"

#include <osgVolumizer/core/accuracy/RaySamples.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace RaySamplesTest {

using namespace osgVolumizer::core;

namespace {

constexpr int ENTRY_COUNT = 1 << 18; // so many entries that the nearest one is exact to 1e-5

// A table of constant colour, with integrals of extinction by the midpoint rule.
struct Table
{
    Table(const glm::vec3& color, const std::function<double(double)>& extinctionBits)
        : texels(extinctionTexels(ENTRY_COUNT, color, extinctionBits))
    {
    }
    ExtinctionTable midpoints() const { return {texels.data(), ENTRY_COUNT, false}; }
    ExtinctionTable integrals() const { return {texels.data(), ENTRY_COUNT, true}; }
    std::vector<glm::vec4> texels;
};

RaySamples ray(const std::function<double(double)>& value, int intervals, double unitsLong)
{
    RaySamples samples;
    for (int i = 0; i <= intervals; ++i)
        samples.values.push_back(float(value(double(i) / intervals)));
    samples.unitsPerInterval = unitsLong / intervals;
    return samples;
}

const glm::vec3 COLOR(0.5f, 0.25f, 1.0f);

} // namespace

TEST(RaySamples, InterpolatesBetweenValues)
{
    RaySamples samples;
    samples.values = {0.0f, 0.5f, NAN, 0.25f};
    EXPECT_EQ(samples.length(), 3.0);
    EXPECT_EQ(samples.at(0.5), 0.25);
    EXPECT_EQ(samples.at(1.25), 0.5); // the nearer one, since the other shows nothing
    EXPECT_TRUE(std::isnan(samples.at(1.75)));
    EXPECT_EQ(samples.at(3.0), 0.25);
}

TEST(RaySamples, AUniformRayIsExactWithAnyPeriod)
{
    const Table table(COLOR, [](double) { return 0.75; });
    const RaySamples samples = ray([](double) { return 0.3; }, 64, 2.5);
    const double opacity = 1.0 - std::exp2(-0.75 * 2.5);
    for (const ExtinctionTable& t : {table.midpoints(), table.integrals()})
        for (const double period : {0.5, 1.0, 7.0, 64.0, 1000.0}) {
            const glm::dvec4 light = samples.integrate(t, period);
            EXPECT_NEAR(light.a, opacity, 1e-12);
            EXPECT_NEAR(light.r, 0.5 * opacity, 1e-12);
            EXPECT_NEAR(light.b, opacity, 1e-12);
        }
}

TEST(RaySamples, WhatShowsNothingAddsNothing)
{
    const Table table(COLOR, [](double) { return 1.0; });
    const RaySamples samples =
        ray([](double t) { return t < 0.4999 ? double(NAN) : 0.5; }, 100, 2.0);
    // Of the interval in between, the half that is nearer to the first value that shows.
    EXPECT_NEAR(samples.integrate(table.midpoints(), 0.25).a, 1.0 - std::exp2(-1.01), 1e-12);
}

TEST(RaySamples, EndsWhereNothingPasses)
{
    const Table table(COLOR, [](double) { return 64.0; });
    const glm::dvec4 light =
        ray([](double) { return 0.5; }, 100, 1.0).integrate(table.midpoints(), 1.0);
    EXPECT_GT(light.a, 1.0 - 3e-5);
    EXPECT_LT(light.a, 1.0);
}

TEST(RaySamples, TheMidpointRuleIsOfSecondOrder)
{
    // Extinction along the ray is 3t^2, whose integral is 1.
    const Table table(COLOR, [](double v) { return 3.0 * v * v; });
    const RaySamples samples = ray([](double t) { return t; }, 256, 1.0);
    const auto error = [&](double period) {
        return 0.5 - samples.integrate(table.midpoints(), period).a;
    };
    EXPECT_NEAR(error(1.0), 0.0, 2e-5);
    for (const double period : {128.0, 64.0, 32.0}) {
        EXPECT_GT(error(period), 1e-4);
        EXPECT_NEAR(error(period) / error(0.5 * period), 4.0, 0.2);
    }
}

TEST(RaySamples, IntegralsAreExactForLinearRays)
{
    const Table table(COLOR, [](double v) { return v > 0.4 && v < 0.45 ? 20.0 : 0.0; });
    const RaySamples samples = ray([](double t) { return t; }, 64, 1.0);
    const double expected = 1.0 - std::exp2(-20.0 * 0.05);
    for (const double period : {64.0, 16.0, 1.0}) {
        const glm::dvec4 light = samples.integrate(table.integrals(), period);
        EXPECT_NEAR(light.a, expected, 1e-4);
        EXPECT_NEAR(light.g, 0.25 * expected, 1e-4);
    }
    // Steps that are longer than the peak is wide miss it.
    EXPECT_EQ(samples.integrate(table.midpoints(), 64.0).a, 0.0);
    EXPECT_NEAR(samples.integrate(table.midpoints(), 0.1).a, expected, 2e-3);
}

TEST(ExtinctionTable, ReadsTheNearestEntry)
{
    const std::vector<glm::vec4> texels = {{0, 0, 0, 1}, {0, 0, 0, 2}, {0, 0, 0, 3}};
    const ExtinctionTable table{texels.data(), 3, false};
    EXPECT_EQ(table.at(0.24).a, 1.0);
    EXPECT_EQ(table.at(0.26).a, 2.0);
    EXPECT_EQ(table.at(-5.0).a, 1.0);
    EXPECT_EQ(table.at(5.0).a, 3.0);
    EXPECT_EQ(table.at(NAN), glm::dvec4(0.0));
    EXPECT_FALSE(table.empty());
    EXPECT_TRUE(ExtinctionTable().empty());
}

TEST(ExtinctionTable, MeansRunEitherWay)
{
    const Table table(COLOR, [](double v) { return 8.0 * v; });
    const ExtinctionTable t = table.integrals();
    EXPECT_NEAR(t.mean(0.25, 0.75).a, 4.0, 1e-3);
    EXPECT_NEAR(t.mean(0.75, 0.25).a, 4.0, 1e-3);
    EXPECT_NEAR(t.mean(0.75, 0.25).r, 0.5, 1e-3);
    EXPECT_NEAR(t.mean(0.5, 0.5).a, 4.0, 1e-3);
    EXPECT_EQ(t.mean(0.5, NAN), t.at(0.5));
    EXPECT_EQ(t.mean(NAN, NAN), glm::dvec4(0.0));
}

} // namespace RaySamplesTest
