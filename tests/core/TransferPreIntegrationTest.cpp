#include <osgVolumizer/core/transfer/PreIntegration.h>
#include <osgVolumizer/core/transfer/Resampling.h>

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

glm::dvec4 marched(const TransferFunction& f, double front, double back, double length, int n)
{
    glm::dvec3 color(0.0);
    double depth = 0.0;
    for (int i = 0; i < n; ++i) {
        const glm::dvec4 c = f.evaluate(front + (back - front) * (i + 0.5) / n);
        const double d = extinctionFromOpacity(c.a) * length / n;
        color += std::exp(-depth) * opacityFromExtinction(d, 1.0) * glm::dvec3(c);
        depth += d;
    }
    return glm::dvec4(color, -std::expm1(-depth));
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

TEST(PreIntegration, TableIsSymmetricAndItsDiagonalTheFunction)
{
    const TransferFunction f = coloured();
    const PreIntegratedTable table = preIntegrate(f, 33, -0.1, 1.1);
    ASSERT_EQ(33u * 33u, table.texels.size());
    for (std::size_t i = 0; i < 33; ++i)
        for (std::size_t j = 0; j < 33; ++j)
            ASSERT_EQ(table.texels[i + 33 * j], table.texels[j + 33 * i]);
    const auto entries = f.tabulateExtinction(33, -0.1, 1.1, false);
    for (std::size_t i = 0; i < 33; ++i) {
        EXPECT_FLOAT_EQ(entries[i].a, table.texels[34 * i].a);
        EXPECT_NEAR(entries[i].a * entries[i].r, table.texels[34 * i].r, 1e-6);
    }
}

namespace {

/// Largest error of the colour of segments between multiples of 1/8. The steps of the march are a
/// multiple of 1 to 8, so that a jump at 1/2 falls between two of them.
double worstSegment(const TransferFunction& f, int count, double length)
{
    const PreIntegratedTable table = preIntegrateSegment(f, count, 0.0, 1.0, length);
    const std::size_t n = static_cast<std::size_t>(count), step = (n - 1) / 8;
    const TransferIntegral integral(f);
    double error = 0.0;
    for (std::size_t i = 0; i < n; i += step)
        for (std::size_t j = 0; j < n; j += step) {
            const double front = static_cast<double>(i) / (count - 1);
            const double back = static_cast<double>(j) / (count - 1);
            const glm::dvec4 exact = marched(f, front, back, length, 16800);
            const glm::dvec4 entry(table.texels[i + n * j]);
            for (int c = 0; c < 3; ++c)
                error = std::max(error, std::fabs(entry[c] - exact[c]));
            EXPECT_NEAR(opacityFromExtinction(integral.mean(front, back).a, length), entry.a, 1e-7);
        }
    return error;
}

} // namespace

TEST(PreIntegration, SegmentsWithAttenuationAgreeWithMarching)
{
    for (const double length : {0.1, 1.0, 5.0}) {
        EXPECT_LT(worstSegment(coloured(), 33, length), 2e-5);
        EXPECT_LT(worstSegment(stepped(), 33, length), 2e-5);
        EXPECT_LT(worstSegment(TransferFunction(), 33, length), 2e-5);
    }
}

TEST(PreIntegration, AttenuationFavoursTheFront)
{
    const auto f = *TransferFunction::create({{0.0, {1, 0, 0, 0.9}}, {1.0, {0, 0, 1, 0.9}}});
    const PreIntegratedTable table = preIntegrateSegment(f, 2, 0.0, 1.0, 3.0);
    const glm::vec4 redInFront = table.texels[0 + 2 * 1], blueInFront = table.texels[1 + 2 * 0];
    EXPECT_GT(redInFront.r, redInFront.b);
    EXPECT_GT(blueInFront.b, blueInFront.r);
    EXPECT_FLOAT_EQ(redInFront.a, blueInFront.a);
}

TEST(TransferResampling, ErrorBoundsADenseComparison)
{
    for (const TexelPlaces places : {TexelPlaces::ENDS, TexelPlaces::CENTERS})
        for (const int count : {7, 64, 129}) {
            const TransferFunction f = coloured();
            const auto texels =
                f.tabulateExtinction(count, 0.0, 1.0, places == TexelPlaces::CENTERS);
            double dense = 0.0;
            for (int i = 0; i <= 200000; ++i) {
                const double t = i / 200000.0;
                double x = places == TexelPlaces::CENTERS ? t * count - 0.5 : t * (count - 1);
                x = std::min(std::max(x, 0.0), count - 1.0);
                const std::size_t k =
                    static_cast<std::size_t>(std::min(std::floor(x), count - 2.0));
                const double w = x - static_cast<double>(k);
                const glm::dvec4 v =
                    (1 - w) * glm::dvec4(texels[k]) + w * glm::dvec4(texels[k + 1]);
                const glm::dvec4 exact = f.evaluate(t);
                const double alpha = opacityFromExtinction(v.a, 1.0);
                dense = std::max(dense, std::fabs(alpha - exact.a));
                for (int c = 0; c < 3; ++c)
                    dense = std::max(dense, std::fabs(alpha * v[c] - exact.a * exact[c]));
            }
            const double estimate = resamplingError(f, count, 0.0, 1.0, places);
            EXPECT_GE(estimate, 0.95 * dense);
            EXPECT_LE(estimate, 1.001 * dense);
        }
}

TEST(TransferResampling, ChoosesAsManyTexelsAsItTakes)
{
    // Opacity and colour constant: two texels do.
    const auto flat = *TransferFunction::create({{0.0, glm::dvec4(0.5)}});
    EXPECT_EQ(2, chooseTexelCount(flat, 0.0, 1.0, TexelPlaces::ENDS).count);
    const auto smooth = *TransferFunction::create({{0.0, glm::dvec4(0.0)}, {1.0, glm::dvec4(0.9)}});
    const TexelChoice choice = chooseTexelCount(smooth, 0.0, 1.0, TexelPlaces::ENDS);
    EXPECT_LE(choice.error, 1e-4);
    EXPECT_LE(choice.count, 257);
    EXPECT_EQ(choice.error, resamplingError(smooth, choice.count, 0.0, 1.0, TexelPlaces::ENDS));
    // Ten points at even places: a multiple of nine steps hits them all.
    std::vector<glm::dvec4> entries;
    for (int i = 0; i < 10; ++i)
        entries.emplace_back(i % 2, 0.5, 0.5, i % 2 ? 0.3 : 0.1);
    const auto zigzag = *TransferFunction::createUniform(entries);
    const TexelChoice even = chooseTexelCount(zigzag, 0.0, 1.0, TexelPlaces::ENDS);
    EXPECT_LE(even.error, 1e-4);
    EXPECT_EQ(0, (even.count - 1) % 9);
}

TEST(TransferResampling, AJumpTakesWhatThereIs)
{
    const TexelChoice choice = chooseTexelCount(stepped(), 0.0, 1.0, TexelPlaces::ENDS);
    EXPECT_GT(choice.error, 1e-4);
    EXPECT_LE(choice.count, 4096);
}

} // namespace TransferPreIntegrationTest
