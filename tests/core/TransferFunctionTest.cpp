#include <osgVolumizer/core/transfer/TransferFunction.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace TransferFunctionTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using Point = TransferFunction::Point;

TEST(TransferFunction, DefaultIsAGreyRamp)
{
    const TransferFunction ramp;
    EXPECT_EQ(glm::dvec4(0.25), ramp.evaluate(0.25));
    EXPECT_EQ(glm::dvec4(0.0), ramp.evaluate(-3.0));
    EXPECT_EQ(glm::dvec4(1.0), ramp.evaluate(INFINITY));
    EXPECT_EQ(glm::dvec4(0.0), ramp.evaluate(NAN));
}

TEST(TransferFunction, TheLaterPointOfAJumpHoldsFromThere)
{
    const auto step = TransferFunction::create(
        {{0.0, glm::dvec4(0.0)}, {0.5, glm::dvec4(0.0)}, {0.5, glm::dvec4(1.0)}});
    ASSERT_TRUE(step.ok());
    EXPECT_EQ(0.0, step->evaluate(std::nextafter(0.5, 0.0)).a);
    EXPECT_EQ(1.0, step->evaluate(0.5).a);
}

TEST(TransferFunction, ExtremeOpacitiesAreExact)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<Point> points(1 + random() % 6);
        double value = 0.0;
        for (Point& p : points)
            p = {value += uniform(random) < 0.3 ? 0.0 : uniform(random),
                 glm::dvec4(0, 0, 0, uniform(random))};
        const TransferFunction f = *TransferFunction::create(points);
        const double low = 4.0 * uniform(random) - 0.5, high = low + 2.0 * uniform(random);
        const double maximum = f.maximumOpacity(low, high);
        const double minimum = f.minimumOpacity(low, high);
        for (int i = 0; i <= 1000; ++i) {
            const double sampled = f.evaluate(low + (high - low) * i / 1000).a;
            EXPECT_GE(maximum, sampled - 1e-15);
            EXPECT_LE(minimum, sampled + 1e-15);
        }
        // Attained: at an end, or at a point inside.
        for (const double extreme : {maximum, minimum}) {
            bool attained = extreme == f.evaluate(low).a || extreme == f.evaluate(high).a;
            for (const Point& p : points)
                attained = attained || (p.value >= low && p.value <= high && p.color.a == extreme);
            EXPECT_TRUE(attained);
        }
    }
    EXPECT_EQ(0.0, TransferFunction().maximumOpacity(1.0, 0.0));
    EXPECT_EQ(0.0, TransferFunction().maximumOpacity(NAN, 1.0));
    EXPECT_EQ(0.0, TransferFunction().minimumOpacity(1.0, 0.0));
}

TEST(TransferFunction, MapsValues)
{
    const TransferFunction f = TransferFunction().mapped(200.0, -100.0);
    EXPECT_EQ(glm::dvec4(0.5), f.evaluate(0.0));
    EXPECT_EQ(glm::dvec4(1.0), f.evaluate(100.0));
}

TEST(TransferFunction, TabulatesExtinction)
{
    const TransferFunction ramp;
    const auto ends = ramp.tabulateExtinction(5, 0.0, 1.0, false);
    ASSERT_EQ(5u, ends.size());
    EXPECT_FLOAT_EQ(0.25f, ends[1].r);
    EXPECT_FLOAT_EQ(static_cast<float>(-std::log(0.75)), ends[1].a);
    EXPECT_TRUE(std::isfinite(ends[4].a));
    const auto centers = ramp.tabulateExtinction(4, 0.0, 1.0, true);
    EXPECT_FLOAT_EQ(0.125f, centers[0].r);
    EXPECT_FLOAT_EQ(0.875f, centers[3].r);
}

TEST(TransferFunction, ExtinctionAndOpacityAreInverse)
{
    for (const double alpha : {0.0, 1e-12, 0.3, 0.999}) {
        EXPECT_NEAR(alpha, opacityFromExtinction(extinctionFromOpacity(alpha), 1.0), 1e-15);
        // A layer twice as thick lets the square of the light through.
        EXPECT_NEAR(1.0 - (1.0 - alpha) * (1.0 - alpha),
                    opacityFromExtinction(extinctionFromOpacity(alpha), 2.0), 1e-15);
    }
    EXPECT_NEAR(1.0, opacityFromExtinction(extinctionFromOpacity(1.0), 1.0), 1e-7);
    EXPECT_EQ(0.0, extinctionFromOpacity(NAN));
}

TEST(TransferFunction, RefusalsNameTheOffender)
{
    EXPECT_EQ(ErrorCode::VALUE_INVALID, TransferFunction::create({}).status.code);
    const Point good{0.0, glm::dvec4(0.5)};
    const auto status = [&](Point bad) { return TransferFunction::create({good, bad}).status; };
    for (const Point& bad :
         {Point{NAN, glm::dvec4(0.5)}, Point{INFINITY, glm::dvec4(0.5)},
          Point{-1.0, glm::dvec4(0.5)}, Point{1.0, glm::dvec4(0, 0, 1.5, 0)},
          Point{1.0, glm::dvec4(0, NAN, 0, 0)}, Point{1.0, glm::dvec4(0, 0, 0, -0.1)}}) {
        EXPECT_EQ(ErrorCode::VALUE_INVALID, status(bad).code);
        EXPECT_EQ(1, status(bad).index);
    }
    EXPECT_NE(std::string::npos, status({1.0, glm::dvec4(0, 0, 1.5, 0)}).text.find("b = 1.5"));
}

TEST(TransferFunction, UniformEntries)
{
    const auto one = TransferFunction::createUniform({glm::dvec4(0.3)});
    ASSERT_TRUE(one.ok());
    EXPECT_EQ(glm::dvec4(0.3), one->evaluate(0.9));
    const auto three =
        TransferFunction::createUniform({glm::dvec4(0.0), glm::dvec4(1.0), glm::dvec4(0.0)});
    EXPECT_EQ(glm::dvec4(0.5), three->evaluate(0.25));
    EXPECT_EQ(ErrorCode::VALUE_INVALID, TransferFunction::createUniform({}).status.code);
}

} // namespace TransferFunctionTest
