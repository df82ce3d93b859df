#include "TableFixture.h"

#include <osgVolumizer/core/accuracy/FilterError.h>

#include <gtest/gtest.h>

#include <cmath>

namespace FilterErrorTest {

using namespace osgVolumizer::core;

namespace {

const Box3d BOX{glm::dvec3(0.0), glm::dvec3(32.0)};

double ramp(const glm::dvec3& p)
{
    return p.x / 32.0;
}

double errorOf(const FractionField& field, const TableForms& table, double weight)
{
    return filterError(field, BOX, glm::dmat3(1.0), table.table, weight);
}

} // namespace

// A ramp of the field and of the table: everywhere the extinction is off by the same.
TEST(FilterError, IsThatOfARamp)
{
    const double steepness = 0.01; // per unit over the range; extinction is opacity, nearly
    const TableForms table(opacityPoints(2, [&](double f) { return steepness * f; }));
    const double weight = 1.0 / 512.0;
    const double expected = steepness * weight / 32.0 * std::sqrt(3.0) * 32.0;
    EXPECT_NEAR(errorOf(ramp, table, weight), expected, 0.02 * expected);
    EXPECT_NEAR(errorOf(ramp, table, 0.25 * weight), 0.25 * expected, 0.02 * expected);
}

TEST(FilterError, IsNoneOfExactWeightsAndOfConstants)
{
    const TableForms table(opacityPoints(2, [](double f) { return 0.1 * f; }));
    EXPECT_EQ(errorOf(ramp, table, 0.0), 0.0);
    EXPECT_EQ(errorOf([](const glm::dvec3&) { return 0.4; }, table, 0.01), 0.0);
    EXPECT_EQ(errorOf([](const glm::dvec3&) { return NAN; }, table, 0.01), 0.0);
}

TEST(FilterError, DecidesWhetherATolerancePermitsThem)
{
    const TableForms table(opacityPoints(2, [](double f) { return 0.01 * f; }));
    const PeriodChoice choice =
        choosePeriod(table.question(1e-3), ramp, BOX, glm::dmat3(1.0), false);
    EXPECT_EQ(choice.filterError, errorOf(ramp, table, 1.0 / 512.0)); // 3.4e-5
    EXPECT_TRUE(choice.permits(1.0 / 512.0, 1e-3));
    EXPECT_FALSE(choice.permits(1.0 / 512.0, 2e-5));
    EXPECT_TRUE(choice.permits(1.0 / 512.0 / 8.0, 2e-5));
    EXPECT_TRUE(choice.permits(0.0, 1e-9));
}

} // namespace FilterErrorTest
