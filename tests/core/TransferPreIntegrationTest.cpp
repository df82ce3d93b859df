#include <osgVolumizer/core/transfer/PreIntegration.h>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace TransferPreIntegrationTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

TransferFunction coloured()
{
    return *TransferFunction::create({{0.0, {0.1, 0.9, 0.4, 0.0}},
                                      {0.3, {0.8, 0.2, 0.0, 0.6}},
                                      {0.31, {0.8, 0.2, 0.5, 0.05}},
                                      {0.7, {0.0, 0.5, 1.0, 0.999}},
                                      {1.0, {1.0, 0.5, 0.2, 0.3}}});
}

TransferFunction stepped()
{
    return *TransferFunction::create({{0.2, {0.1, 0.9, 0.4, 0.1}},
                                      {0.5, {0.8, 0.2, 0.0, 0.1}},
                                      {0.5, {0.3, 0.2, 0.9, 0.8}},
                                      {0.9, {0.3, 0.5, 1.0, 0.4}}});
}

/// Midpoint rule over (extinction * rgb, extinction).
glm::dvec4 midpointMean(const TransferFunction& f, double a, double b, int n)
{
    glm::dvec4 sum(0.0);
    for (int i = 0; i < n; ++i) {
        const glm::dvec4 c = f.evaluate(a + (b - a) * (i + 0.5) / n);
        const double tau = extinctionFromOpacity(c.a);
        sum += glm::dvec4(tau * c.r, tau * c.g, tau * c.b, tau);
    }
    return sum / static_cast<double>(n);
}

void expectNear(const glm::dvec4& a, const glm::dvec4& b, double tolerance)
{
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

} // namespace

TEST(TransferIntegral, AgreesWithQuadratureAtItsOrder)
{
    // The midpoint rule converges to the closed form with order 2 on smooth pieces: the error falls
    // by four.
    const TransferFunction f = coloured();
    const TransferIntegral integral(f);
    const double ends[][2] = {{0.02, 0.29}, {0.35, 0.65}, {0.71, 0.99}};
    for (const auto& e : ends) {
        const glm::dvec4 exact = integral.mean(e[0], e[1]);
        const double coarse = std::fabs(midpointMean(f, e[0], e[1], 100).a - exact.a);
        const double fine = std::fabs(midpointMean(f, e[0], e[1], 200).a - exact.a);
        EXPECT_NEAR(4.0, coarse / fine, 0.2);
        expectNear(midpointMean(f, e[0], e[1], 100000), exact, 1e-8);
    }
}

TEST(TransferIntegral, AcrossPointsJumpsAndTheEnds)
{
    for (const TransferFunction& f : {coloured(), stepped()}) {
        const TransferIntegral integral(f);
        for (const auto& e :
             {std::pair<double, double>{-0.5, 1.5}, {0.1, 0.95}, {-2.0, -1.0}, {1.2, 3.0}})
            expectNear(midpointMean(f, e.first, e.second, 400000), integral.mean(e.first, e.second),
                       2e-5);
    }
}

TEST(TransferIntegral, IsAdditive)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-0.2, 1.2);
    for (const TransferFunction& f : {coloured(), stepped(), TransferFunction()}) {
        const TransferIntegral integral(f);
        for (int i = 0; i < 200; ++i) {
            const double a = uniform(random), b = uniform(random), c = uniform(random);
            expectNear((b - a) * integral.mean(a, b) + (c - b) * integral.mean(b, c),
                       (c - a) * integral.mean(a, c), 1e-13);
        }
    }
}

TEST(TransferIntegral, OpaquePointsStayFinite)
{
    // The mean of -ln(1 - s) over [0, 1] is 1.
    const TransferIntegral ramp{TransferFunction()};
    EXPECT_NEAR(1.0, ramp.mean(0.0, 1.0).a, 1e-7);
    // The mean of -s ln(1 - s) is 3/4.
    EXPECT_NEAR(0.75, ramp.mean(0.0, 1.0).r, 1e-7);
}

TEST(TransferIntegral, TinySegmentsDoNotCancel)
{
    const TransferFunction f = coloured();
    const TransferIntegral integral(f);
    for (const double width : {1e-4, 1e-8, 1e-12, 1e-15}) {
        const glm::dvec4 here = integral.mean(0.5, 0.5);
        expectNear(here, integral.mean(0.5, 0.5 + width), 10.0 * width + 1e-14);
        expectNear(here, integral.mean(0.5 + width, 0.5), 10.0 * width + 1e-14);
    }
}

} // namespace TransferPreIntegrationTest
