#include <oracles/Grid.h>
#include <oracles/Roots.h>
#include <support/Compare.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

namespace FieldTest {

using namespace osgVolumizer;
using namespace osgVolumizer::oracle;

namespace {

glm::dvec3 differences(const Field& field, const glm::dvec3& p, double h)
{
    glm::dvec3 g;
    for (int a = 0; a < 3; ++a) {
        glm::dvec3 step(0.0);
        step[a] = h;
        g[a] = (field.value(p + step) - field.value(p - step)) / (2.0 * h);
    }
    return g;
}

} // namespace

TEST(Field, GradientsAgreeWithDifferencesToSecondOrder)
{
    const std::unique_ptr<Field> fields[] = {
        std::make_unique<ConstantField>(0.3),
        std::make_unique<RampField>(glm::dvec3(0.1, -2.0, 0.7), 0.4),
        std::make_unique<ProductField>(1.7),
        std::make_unique<GaussianField>(glm::dvec3(0.1, 0.2, -0.1), 0.4, 0.9),
        std::make_unique<MarschnerLobbField>()};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-0.9, 0.9);
    for (const auto& field : fields)
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 p(coordinate(random), coordinate(random), coordinate(random));
            const glm::dvec3 exact = field->gradient(p);
            const double coarse = glm::length(differences(*field, p, 1e-3) - exact);
            const double fine = glm::length(differences(*field, p, 1e-4) - exact);
            EXPECT_LT(coarse, 0.1);
            EXPECT_LT(fine, 0.02 * coarse + 1e-10);
        }
}

TEST(Field, MarschnerLobbFillsTheUnitInterval)
{
    const MarschnerLobbField field;
    double low = 1.0, high = 0.0;
    for (int k = -20; k <= 20; ++k)
        for (int i = -100; i <= 100; ++i) {
            const double v = field.value({i / 100.0, 0.0, k / 20.0});
            low = std::min(low, v);
            high = std::max(high, v);
        }
    EXPECT_GE(low, 0.0);
    EXPECT_LE(high, 1.0);
    EXPECT_LT(low, 0.01);
    EXPECT_GT(high, 0.99);
}

TEST(Grid, ReproducesATrilinearFieldExactly)
{
    const ProductField field(0.25);
    const Grid grid({5, 4, 6}, field, glm::dmat4(1.0));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> f(0.0, 1.0);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 p(4.0 * f(random), 3.0 * f(random), 5.0 * f(random));
        EXPECT_NEAR(grid.value(p), field.value(p), 1e-13);
        EXPECT_LT(glm::length(grid.gradient(p) - field.gradient(p)), 1e-12);
    }
    EXPECT_EQ(grid.value({4, 3, 5}), 15.0);
    EXPECT_EQ(grid.value({40, 30, 50}), 15.0);
    EXPECT_EQ(grid.value({-1, 2, 2}), 0.0);
}

TEST(Grid, InterpolationIsOfSecondOrder)
{
    const GaussianField field(glm::dvec3(0.5), 0.3);
    std::vector<double> steps, errors;
    for (int n = 16; n <= 64; n *= 2) {
        glm::dmat4 toField(1.0 / n);
        toField[3][3] = 1.0;
        const Grid grid(glm::ivec3(n + 1), field, toField);
        double worst = 0.0;
        for (int i = 0; i < n * n * n; ++i) {
            const glm::dvec3 p = glm::dvec3(i % n, i / n % n, i / n / n) + 0.5;
            worst = std::max(worst, std::abs(grid.value(p) - field.value(p / double(n))));
        }
        steps.push_back(1.0 / n);
        errors.push_back(worst);
    }
    EXPECT_NEAR(support::convergenceOrder(steps, errors), 2.0, 0.05);
}

TEST(Grid, NearestTakesTheClosestSample)
{
    const Grid grid({2, 1, 1}, {3.0, 7.0}, Grid::NEAREST);
    EXPECT_EQ(grid.value({0.49, 0, 0}), 3.0);
    EXPECT_EQ(grid.value({0.51, 0, 0}), 7.0);
    std::vector<double> breaks;
    grid.appendBreaks(glm::dvec3(0.0), {1, 0, 0}, 0.0, 1.0, {}, breaks);
    ASSERT_EQ(breaks.size(), 1u);
    EXPECT_DOUBLE_EQ(breaks[0], 0.5);
}

TEST(Grid, BreaksAreCellFacesAndRoots)
{
    const Grid grid({4, 2, 2}, RampField({1, 0, 0}, 0.0), glm::dmat4(1.0));
    std::vector<double> breaks;
    grid.appendBreaks({0, 0.5, 0.5}, {1, 0, 0}, 0.0, 3.0, {0.25, 2.5, 9.0}, breaks);
    std::sort(breaks.begin(), breaks.end());
    const auto same = [](double a, double b) { return std::abs(a - b) < 1e-12; };
    breaks.erase(std::unique(breaks.begin(), breaks.end(), same), breaks.end());
    ASSERT_EQ(breaks.size(), 4u);
    const double expected[] = {0.25, 1.0, 2.0, 2.5};
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(breaks[i], expected[i], 1e-12);
}

TEST(Grid, ConvertsVoxelsBothWays)
{
    const std::vector<double> values{-300.0, -1.5, 0.0, 2.5, 70000.0};
    EXPECT_EQ(toDoubles(fromDoubles(values, VoxelType::INT16).data(), 5, VoxelType::INT16),
              (std::vector<double>{-300.0, -1.0, 0.0, 3.0, 32767.0}));
    EXPECT_EQ(toDoubles(fromDoubles(values, VoxelType::UINT8).data(), 5, VoxelType::UINT8),
              (std::vector<double>{0.0, 0.0, 0.0, 3.0, 255.0}));
    EXPECT_EQ(toDoubles(fromDoubles(values, VoxelType::FLOAT32).data(), 5, VoxelType::FLOAT32),
              values);
}

TEST(Roots, FindsEveryRootOfACubic)
{
    const auto cubic = [](double t) { return (t - 1.25) * (t - 1.5) * (t - 1.9); };
    const double f[4] = {cubic(1.0), cubic(4.0 / 3.0), cubic(5.0 / 3.0), cubic(2.0)};
    std::vector<double> roots;
    appendCubicRoots(f, {-10.0, 0.0, 10.0}, 1.0, 2.0, roots);
    ASSERT_EQ(roots.size(), 3u);
    EXPECT_NEAR(roots[0], 1.25, 1e-13);
    EXPECT_NEAR(roots[1], 1.5, 1e-13);
    EXPECT_NEAR(roots[2], 1.9, 1e-13);
}

TEST(Roots, FlatCubicsEndSoon)
{
    const double f[4] = {0.5, 0.5 + 1e-16, 0.5 - 1e-16, 0.5 + 2e-16};
    std::vector<double> roots;
    appendCubicRoots(f, {0.5}, 0.0, 1.0, roots);
    EXPECT_LE(roots.size(), 4u);
}

} // namespace FieldTest
