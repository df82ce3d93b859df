// The sign of a tetrahedron is exact, so neighbours cannot disagree on which side is which.

#include "osgVolumizer/core/geometry/Orientation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace OrientationTest {

using namespace osgVolumizer::core;

namespace {

__extension__ typedef __int128 Wide;

/// With whole coordinates up to 2^40, in whole numbers.
int wideSign(const std::array<std::array<std::int64_t, 3>, 4>& p)
{
    Wide m[3][3];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t a = 0; a < 3; ++a)
            m[i][a] = p[i + 1][a] - p[0][a];
    const Wide d = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
                   m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
                   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return d > 0 ? 1 : d < 0 ? -1 : 0;
}

} // namespace

TEST(Orientation, AgreesWithWholeNumbers)
{
    // Nearly or wholly in a plane: the fourth is a combination of the others, moved by 0 or 1.
    std::mt19937_64 random(3);
    int zero = 0, undecided = 0;
    for (int round = 0; round < 20000; ++round) {
        std::array<std::array<std::int64_t, 3>, 4> p{};
        const int bits = 2 + round % 38;
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t i = 0; i < 3; ++i)
                p[i][a] = static_cast<std::int64_t>(random() >> (64 - bits));
            p[3][a] = p[1][a] + p[2][a] - p[0][a] + static_cast<std::int64_t>(random() % 2);
        }
        glm::dvec3 q[4];
        for (std::size_t i = 0; i < 4; ++i)
            q[i] = glm::dvec3(double(p[i][0]), double(p[i][1]), double(p[i][2])) * 0x1p-20;
        const int sign = wideSign(p);
        ASSERT_EQ(orientationSign(q[0], q[1], q[2], q[3]), sign);
        ASSERT_EQ(orientationSign(q[1], q[0], q[2], q[3]), -sign);
        ASSERT_EQ(orientationSign(q[3], q[2], q[1], q[0]), sign);
        zero += sign == 0;
        const glm::dvec3 u = q[1] - q[0], v = q[2] - q[0], w = q[3] - q[0];
        const double rounded = u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) +
                               u.z * (v.x * w.y - v.y * w.x);
        undecided += (rounded > 0.0 ? 1 : rounded < 0.0 ? -1 : 0) != sign;
    }
    EXPECT_GT(zero, 1000);
    EXPECT_GT(undecided, 10); // where rounding alone would have been wrong
}

TEST(Orientation, CoordinatesOfVeryDifferentSize)
{
    // 1e-30 above a plane through points 1e12 apart.
    const glm::dvec3 a(0, 0, 0), b(1e12, 0, 1e12), c(0, 1e-9, 0);
    EXPECT_EQ(orientationSign(a, b, c, {1.0, 5.0, 1.0}), 0);
    EXPECT_EQ(orientationSign(a, b, c, {0.0, 5.0, 1e-30}), 1);
    EXPECT_EQ(orientationSign(a, b, c, {0.0, 5.0, -1e-30}), -1);
    EXPECT_EQ(orientationSign(a, b, c, {1.0, 5.0, std::nextafter(1.0, 2.0)}), 1);
    EXPECT_EQ(orientationSign(a, b, c, {1.0, 5.0, std::nextafter(1.0, 0.0)}), -1);
}

} // namespace OrientationTest
