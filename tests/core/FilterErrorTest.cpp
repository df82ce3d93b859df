#include "ExtinctionTexels.h"

#include <osgVolumizer/core/accuracy/FilterError.h>

#include <gtest/gtest.h>

#include <cmath>

namespace FilterErrorTest {

using namespace osgVolumizer::core;

namespace {

constexpr int ENTRIES = 4097;

PeriodQuestion question(const std::vector<glm::vec4>& texels)
{
    PeriodQuestion q;
    q.midpoints = {texels.data(), ENTRIES, false};
    q.box = {glm::dvec3(0.0), glm::dvec3(32.0)};
    return q;
}

double ramp(const glm::dvec3& p)
{
    return p.x / 32.0;
}

} // namespace

// A ramp of the field and of the table: everywhere the extinction is off by the same.
TEST(FilterError, IsThatOfARamp)
{
    const double steepness = 0.01; // bits per unit over the range
    const auto texels =
        extinctionTexels(ENTRIES, {1.0f, 0.5f, 0.25f}, [&](double f) { return steepness * f; });
    const double weight = 1.0 / 512.0;
    const double expected = std::log(2.0) * steepness * weight / 32.0 * std::sqrt(3.0) * 32.0;
    EXPECT_NEAR(filterError(ramp, question(texels), weight), expected, 0.02 * expected);
    EXPECT_NEAR(filterError(ramp, question(texels), 0.25 * weight), 0.25 * expected,
                0.02 * expected);
}

TEST(FilterError, IsNoneOfExactWeightsAndOfConstants)
{
    const auto texels =
        extinctionTexels(ENTRIES, glm::vec3(1.0f), [](double f) { return 0.1 * f; });
    EXPECT_EQ(filterError(ramp, question(texels), 0.0), 0.0);
    EXPECT_EQ(filterError([](const glm::dvec3&) { return 0.4; }, question(texels), 0.01), 0.0);
    EXPECT_EQ(filterError([](const glm::dvec3&) { return NAN; }, question(texels), 0.01), 0.0);
}

TEST(FilterError, DecidesWhetherATolerancePermitsThem)
{
    const auto texels =
        extinctionTexels(ENTRIES, {1.0f, 0.5f, 0.25f}, [](double f) { return 0.01 * f; });
    PeriodQuestion q = question(texels);
    const PeriodChoice choice = choosePeriod(ramp, q);
    EXPECT_EQ(choice.filterError, filterError(ramp, q, 1.0 / 512.0)); // 2.3e-5
    EXPECT_TRUE(choice.permits(1.0 / 512.0, 1e-3));
    EXPECT_FALSE(choice.permits(1.0 / 512.0, 2e-5));
    EXPECT_TRUE(choice.permits(1.0 / 512.0 / 8.0, 2e-5));
    EXPECT_TRUE(choice.permits(0.0, 1e-9));
}

} // namespace FilterErrorTest
