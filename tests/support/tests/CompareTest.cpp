#include <support/Compare.h>

#include <support/PictureFile.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace CompareTest {

using namespace osgVolumizer::support;

TEST(Compare, MeasuresOverCoveredPixelsOnly)
{
    FloatImage a(4, 2), b(4, 2);
    a.at(1, 1) = {0.5f, 0.5f, 0.5f, 1.0f};
    b.at(1, 1) = {0.5f, 0.25f, 0.5f, 1.0f};
    const Difference d = compare(a, b);
    EXPECT_EQ(d.pixels, 1u);
    EXPECT_DOUBLE_EQ(d.maximum, 0.25);
    EXPECT_DOUBLE_EQ(d.bias, 0.25 / 4.0);
    EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(0.0625 / 4.0));
    EXPECT_EQ(d.worstX, 1);
    EXPECT_EQ(d.worstY, 1);
}

TEST(Compare, ComparingNothingIsInfinitelyFar)
{
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(compare(FloatImage(4, 4), FloatImage(4, 4)).rmse, infinity);
    EXPECT_EQ(compare(FloatImage(4, 4, glm::vec4(1.0f)), FloatImage(4, 5)).rmse, infinity);
    EXPECT_EQ(compare(FloatImage(), FloatImage()).maximum, infinity);
}

TEST(Compare, NotANumberIsInfinitelyFar)
{
    FloatImage a(2, 2, glm::vec4(1.0f)), b = a;
    a.at(0, 1).r = std::numeric_limits<float>::quiet_NaN();
    const Difference d = compare(a, b);
    EXPECT_EQ(d.maximum, std::numeric_limits<double>::infinity());
    EXPECT_EQ(d.rmse, std::numeric_limits<double>::infinity());
    EXPECT_EQ(d.worstY, 1);
}

TEST(Compare, ErosionTakesOffTheRim)
{
    FloatImage image(9, 9);
    for (int y = 2; y < 7; ++y)
        for (int x = 2; x < 7; ++x)
            image.at(x, y).a = 1.0f;
    const Mask mask = coveredPixels(image);
    EXPECT_EQ(mask.count(), 25u);
    EXPECT_EQ(eroded(mask, 1).count(), 9u);
    EXPECT_EQ(eroded(mask, 2).count(), 1u);
    EXPECT_EQ(eroded(mask, 3).count(), 0u);
}

TEST(Compare, FindsTheOrderOfConvergence)
{
    EXPECT_NEAR(convergenceOrder({1.0, 0.5, 0.25}, {3.0, 0.75, 0.1875}), 2.0, 1e-12);
    EXPECT_TRUE(std::isnan(convergenceOrder({1.0}, {1.0})));
}

TEST(PictureFile, FloatsSurviveTheRoundTrip)
{
    FloatImage image(3, 2, glm::vec4(0.0f, 0.0f, 0.0f, 0.5f));
    image.at(0, 0) = {1e-7f, 3.0f, -2.0f, 0.25f};
    image.at(2, 1) = {0.1f, 0.2f, 0.3f, 1.0f};
    const std::string name = (std::filesystem::path(testing::TempDir()) / "roundtrip.exr").string();
    ASSERT_TRUE(writeFloatPicture(image, name).ok());
    const auto read = readFloatPicture(name);
    ASSERT_TRUE(read.ok()) << read.status.text;
    ASSERT_EQ(read->width, 3);
    ASSERT_EQ(read->height, 2);
    EXPECT_EQ(read->pixels, image.pixels);
}

TEST(PictureFile, NamesTheFileThatItCannotWrite)
{
    const auto status = writePicture(FloatImage(1, 1), "/nowhere/at/all.exr");
    EXPECT_FALSE(status.ok());
    EXPECT_NE(status.text.find("/nowhere/at/all.exr"), std::string::npos) << status.text;
    EXPECT_FALSE(writePicture(FloatImage(), "empty.png").ok());
}

} // namespace CompareTest
