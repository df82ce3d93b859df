#include <osgVolumizer/core/transfer/IntervalTable.h>

#include <gtest/gtest.h>

#include <cmath>

namespace IntervalTableTest {

using namespace osgVolumizer::core;

namespace {

TransferFunction function(const std::vector<TransferFunction::Point>& points)
{
    return *TransferFunction::create(points);
}

double bits(double opacity)
{
    return -std::log2(1.0 - opacity);
}

const std::vector<TransferFunction::Point> JUMP{
    {0.0, {1, 0, 0, 0.0}}, {0.5, {1, 0, 0, 0.1}}, {0.5, {0, 1, 0, 0.2}}, {1.0, {0, 1, 0, 0.2}}};

} // namespace

TEST(IntervalTable, ACornerHasTwoSides)
{
    const IntervalTable table = makeIntervalTable(function(JUMP), 0.03);
    ASSERT_EQ(table.intervals, 4); // before, to the jump, from there on, behind
    EXPECT_EQ(table.find(-5.0), 0);
    EXPECT_EQ(table.find(0.25), 1);
    EXPECT_EQ(table.find(0.5), 2);
    EXPECT_EQ(table.find(7.0), 3);
    EXPECT_NEAR(table.at(1, 0.5).a, bits(0.1), 1e-6);
    EXPECT_NEAR(table.at(2, 0.5).a, bits(0.2), 1e-6);
    EXPECT_NEAR(table.at(1, 0.9).a, bits(0.1), 1e-6); // held to its interval
    EXPECT_EQ(table.at(1, 0.5).g, 0.0);
    EXPECT_EQ(table.at(2, 0.5).g, 1.0);
    EXPECT_NEAR(table.at(1, 0.25).a, bits(0.05), 1e-6);
}

TEST(IntervalTable, IsTheFunctionEverywhere)
{
    std::vector<TransferFunction::Point> points;
    for (int i = 0; i <= 64; ++i) {
        const double v = i / 64.0;
        points.push_back({v, {v, 0.5 * v, 1.0 - v, 0.98 * v * v}});
    }
    for (const double sharpness : {0.0, 0.03, 1e9}) {
        const TransferFunction f = function(points);
        const IntervalTable table = makeIntervalTable(f, sharpness);
        for (int i = 0; i <= 1000; ++i) {
            const double v = i / 1000.0;
            const glm::dvec4 a = table.at(table.find(v), v), b = f.evaluate(v);
            EXPECT_NEAR(a.r, b.r, 2e-6) << v;
            EXPECT_NEAR(a.a, bits(b.a), 2e-5 * (1.0 + bits(b.a))) << v;
        }
    }
}

TEST(IntervalTable, OnlySharpKinksAreCorners)
{
    const auto count = [](double kink, double sharpness) {
        return makeIntervalTable(function({{0.0, {1, 1, 1, 0.0}},
                                           {0.5, {1, 1, 1, 0.01}},
                                           {1.0, {1, 1, 1, 0.02 + 0.5 * kink}}}),
                                 sharpness)
            .intervals;
    };
    EXPECT_EQ(count(0.02, 0.03), 3);
    EXPECT_EQ(count(0.05, 0.03), 4);
    EXPECT_EQ(count(0.02, 0.0), 4);
}

// So that extinction within an interval is near a polynomial.
TEST(IntervalTable, NearlyOpaqueRampsAreCut)
{
    const IntervalTable table =
        makeIntervalTable(function({{0.0, {1, 1, 1, 0.0}}, {1.0, {1, 1, 1, 0.9}}}), 0.03);
    EXPECT_EQ(table.intervals, 2 + 7); // log(10) / log(1.4) = 6.8
    for (int i = 1; i + 2 < table.intervals; ++i)
        EXPECT_LT(table.largestExtinction(i), table.largestExtinction(i + 1));
    EXPECT_EQ(table.largestExtinction(0), 0.0);
    EXPECT_NEAR(table.largestExtinction(table.intervals - 1), bits(0.9), 1e-5);
}

TEST(IntervalTable, OpaqueAndSinglePoints)
{
    const IntervalTable one = makeIntervalTable(function({{0.5, {1, 1, 1, 1.0}}}), 0.03);
    EXPECT_EQ(one.intervals, 2);
    for (const double v : {-1.0, 0.5, 2.0})
        EXPECT_NEAR(one.at(one.find(v), v).a, 24.0, 1e-4);
    EXPECT_TRUE(IntervalTable().empty());
}

} // namespace IntervalTableTest
