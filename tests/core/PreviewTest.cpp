#include <osgVolumizer/core/transfer/VisibleSphere.h>
#include <osgVolumizer/core/voxels/Preview.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace PreviewTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

template <class Field>
std::vector<float> sampled(const glm::ivec3& size, Field field)
{
    std::vector<float> values;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                values.push_back(static_cast<float>(field(glm::dvec3(x, y, z))));
    return values;
}

double smoothnessOf(const std::vector<float>& values, const glm::ivec3& size)
{
    Preview preview(size);
    preview.add({values.data(), VoxelType::FLOAT32, 1, size});
    return preview.smoothness();
}

const TransferFunction SHOWS_HIGH = *TransferFunction::create({{0.0, glm::dvec4(0.0)},
                                                               {0.5, glm::dvec4(0.0)},
                                                               {0.5, glm::dvec4(1.0)},
                                                               {1.0, glm::dvec4(1.0)}});

} // namespace

TEST(Preview, SmoothnessTellsNoiseFromFields)
{
    const glm::ivec3 size(40, 20, 20);
    std::mt19937 random(7);
    std::normal_distribution<double> noise;
    EXPECT_NEAR(smoothnessOf(sampled(size, [&](auto) { return noise(random); }), size), 1.0, 0.1);
    EXPECT_GT(smoothnessOf(sampled(size, [](auto p) { return std::sin(0.3 * p.x); }), size), 3.7);
    EXPECT_NEAR(smoothnessOf(sampled(size, [](auto p) { return p.x < 17 ? 0 : 5; }), size), 2.0,
                0.1);
    EXPECT_EQ(smoothnessOf(sampled(size, [](auto) { return 3.0; }), size), 0.0);
    EXPECT_EQ(smoothnessOf(sampled(size, [](auto) { return NAN; }), size), 0.0);
}

TEST(Preview, IsARegularSubsetOfAnyParts)
{
    const glm::ivec3 size(200, 200, 210); // more than four million
    Preview preview(size);
    ASSERT_EQ(preview.step(), 2);
    const auto field = [](const glm::dvec3& p) { return p.x + 1000.0 * p.y + 0.001 * p.z; };
    const auto value = [&](const glm::ivec3& p) {
        return voxelValue(preview.view(),
                          p.x + preview.view().size.x *
                                    (p.y + std::int64_t(preview.view().size.y) * p.z));
    };
    EXPECT_EQ(preview.view().size, glm::ivec3(100, 100, 105));
    EXPECT_TRUE(std::isnan(value({3, 4, 5})));
    // Parts that begin at odd samples, and overlap.
    for (const int first : {0, 67, 133}) {
        const glm::ivec3 part(200, 200, first == 133 ? 77 : 70);
        const std::vector<float> values =
            sampled(part, [&](glm::dvec3 p) { return field(p + glm::dvec3(0, 0, first)); });
        preview.add({values.data(), VoxelType::FLOAT32, 1, part}, {0, 0, first});
    }
    for (const glm::ivec3& p : {glm::ivec3(0), glm::ivec3(99, 99, 104), glm::ivec3(3, 50, 34)})
        EXPECT_EQ(value(p), static_cast<float>(field(2.0 * glm::dvec3(p))));
}

TEST(VisibleSphere, IsAroundWhatShows)
{
    const glm::ivec3 size(64, 48, 40);
    const glm::dvec3 center(40, 20, 18), spacing(1.0, 1.0, 2.0);
    // A ball of 10 object units, and a single bright sample far off.
    auto values = sampled(size, [&](const glm::dvec3& p) {
        return glm::distance(p * spacing, center * spacing) < 10.0 ? 1.0 : 0.0;
    });
    values[0] = 1.0f;
    const auto sphere = visibleSphere({values.data(), VoxelType::FLOAT32, 1, size}, {0.0, 1.0},
                                      SHOWS_HIGH, spacing);
    ASSERT_TRUE(sphere.has_value());
    EXPECT_LT(glm::distance(sphere->center, center * spacing), 2.5);
    EXPECT_GT(sphere->radius, 9.5);
    EXPECT_LT(sphere->radius, 14.0); // and a cell
}

TEST(VisibleSphere, OfEverythingAndOfNothing)
{
    const std::vector<float> ones(20 * 20 * 20, 1.0f), zeros(ones.size(), 0.0f),
        nan(ones.size(), NAN);
    const auto of = [](const std::vector<float>& v) {
        return visibleSphere({v.data(), VoxelType::FLOAT32, 1, glm::ivec3(20)}, {0.0, 1.0},
                             SHOWS_HIGH, glm::dvec3(1.0));
    };
    ASSERT_TRUE(of(ones).has_value());
    EXPECT_LT(glm::distance(of(ones)->center, glm::dvec3(9.5)), 1e-6);
    EXPECT_NEAR(of(ones)->radius, 10.0 * std::sqrt(3.0), 1.5);
    EXPECT_FALSE(of(zeros).has_value());
    EXPECT_FALSE(of(nan).has_value());
}

} // namespace PreviewTest
