#include <osgVolumizer/core/transfer/ScanStatistics.h>

#include <gtest/gtest.h>

#include <cmath>

namespace TransferSuggestionTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

/// A ball of one value in another, with a ripple on both.
std::vector<float> ball(int n, float inside, float outside)
{
    std::vector<float> v;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const double c = 0.5 * (n - 1), dx = x - c, dy = y - c, dz = z - c;
                const bool in = dx * dx + dy * dy + dz * dz < 0.16 * n * n;
                v.push_back((in ? inside : outside) + 0.02f * static_cast<float>((x + y + z) % 3));
            }
    return v;
}

TransferFunction suggest(const std::vector<float>& v, int n, const ValueRange& range)
{
    ScanStatistics statistics(glm::ivec3(n), range);
    statistics.add({v.data(), VoxelType::FLOAT32, 1, glm::ivec3(n)});
    return suggestTransferFunction(statistics);
}

} // namespace

TEST(TransferSuggestion, OtsuPartsTwoClassesInTheMiddleOfTheirGap)
{
    std::vector<std::uint64_t> h(256, 0);
    h[10] = 1000, h[11] = 500, h[200] = 100, h[210] = 100;
    const int threshold = otsuThreshold(h);
    EXPECT_EQ((11 + 199) / 2, threshold);
    EXPECT_EQ(-1, otsuThreshold(std::vector<std::uint64_t>(256, 0)));
    std::vector<std::uint64_t> one(256, 0);
    one[7] = 5;
    EXPECT_EQ(-1, otsuThreshold(one));
}

TEST(TransferSuggestion, TheBackgroundIsTransparentWhicheverSideItIs)
{
    for (const bool bright : {true, false}) {
        const auto v = ball(32, bright ? 0.8f : 0.1f, bright ? 0.1f : 0.8f);
        const TransferFunction f = suggest(v, 32, {0.0, 1.0});
        EXPECT_EQ(0.0, f.evaluate(bright ? 0.12 : 0.82).a);
        EXPECT_GT(f.evaluate(bright ? 0.82 : 0.1).a, 0.02);
        EXPECT_GT(f.evaluate(bright ? 0.82 : 0.1).r, 0.5);
    }
}

TEST(TransferSuggestion, OpticalDepthDoesNotDependOnResolution)
{
    for (const int n : {16, 32, 64}) {
        const auto v = ball(n, 0.8f, 0.1f);
        const TransferFunction f = suggest(v, n, {0.0, 1.0});
        // Along the middle row.
        double depth = 0.0;
        for (int x = 0; x < n; ++x)
            depth += extinctionFromOpacity(
                f.evaluate(static_cast<double>(
                               v[static_cast<std::size_t>(x + n * (n / 2) + n * n * (n / 2))]))
                    .a);
        EXPECT_GT(depth, 6.0) << n;
        EXPECT_LT(depth, 13.0) << n;
    }
}

TEST(TransferSuggestion, StrangeData)
{
    // Nothing but NaN, one value, and values outside the range: a valid function, and something to
    // see.
    const std::vector<float> nan(64, NAN), one(64, 3.0f), far(64, 1e30f);
    for (const auto* v : {&nan, &one, &far}) {
        const TransferFunction f = suggest(*v, 4, {0.0, 1.0});
        EXPECT_GT(f.maximumOpacity(0.0, 1.0), 0.0);
        EXPECT_LT(f.maximumOpacity(0.0, 1.0), 1.0);
    }
}

TEST(TransferSuggestion, PartsAddUp)
{
    const auto v = ball(16, 0.8f, 0.1f);
    ScanStatistics whole(glm::ivec3(16), {0.0, 1.0}), parts(glm::ivec3(16), {0.0, 1.0});
    whole.add({v.data(), VoxelType::FLOAT32, 1, glm::ivec3(16)});
    parts.add({v.data(), VoxelType::FLOAT32, 1, {16, 16, 6}});
    parts.add({v.data() + 16 * 16 * 6, VoxelType::FLOAT32, 1, {16, 16, 10}}, {0, 0, 6});
    EXPECT_EQ(whole.all(), parts.all());
    EXPECT_EQ(whole.inner(), parts.inner());
    EXPECT_EQ(whole.border(), parts.border());
}

} // namespace TransferSuggestionTest
