#include "osgVolumizer/core/sampling/ViewHelpers.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ViewHelpersTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

View lookFrom(const glm::dvec3& eye, const glm::dvec3& center)
{
    View v;
    v.toEye = glm::lookAt(eye, center, glm::dvec3(0.1, 0.9, 0.3));
    v.projection = glm::perspective(1.0, 1.5, 0.5, 2000.0);
    return v;
}

} // namespace

TEST(ViewHelpers, EyeAndDirectionInAnyProjection)
{
    const glm::dvec3 eye(3.0, -40.0, 12.0), center(1.0, 2.0, 3.0);
    View v = lookFrom(eye, center);
    const glm::dvec3 direction = glm::normalize(center - eye);
    EXPECT_LT(glm::length(glm::dvec3(*eyePosition(v)) - eye), 1e-12);
    EXPECT_LT(glm::length(*viewDirectionAt(v, glm::dvec3(*eyePosition(v))) - direction), 1e-14);
    v.projection = glm::frustum(-0.1, 0.7, -0.2, 0.1, 0.5, 90.0); // off-axis
    EXPECT_LT(glm::length(glm::dvec3(*eyePosition(v)) - eye), 1e-12);
    EXPECT_EQ(eyePosition(v)->w, 1.0);
    v.projection = glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1)) * v.projection; // mirrored
    EXPECT_LT(glm::length(glm::dvec3(*eyePosition(v)) - eye), 1e-12);
    v.projection = glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, 0, 0)) *
                   glm::ortho(-4.0, 5.0, -3.0, 3.0, 1.0, 100.0);
    ASSERT_EQ(eyePosition(v)->w, 0.0);
    EXPECT_LT(glm::length(glm::dvec3(*eyePosition(v)) + direction), 1e-14);
    EXPECT_LT(glm::length(*viewDirectionAt(v, center) - direction), 1e-14);
}

TEST(ViewHelpers, SingularIsJudgedWithoutRegardToScaleAndPlace)
{
    for (const double scale : {1e-9, 1e-6, 1.0, 1e6, 1e12}) {
        View v =
            lookFrom(glm::dvec3(6.4e6, -3.2e6, 1e6), glm::dvec3(6.4e6 + 1.0, -3.2e6, 1e6 + 2.0));
        v.toEye = v.toEye * glm::scale(glm::dmat4(1.0), glm::dvec3(scale, -2.0 * scale, scale));
        EXPECT_TRUE(eyePosition(v).ok()) << scale;
        const glm::dvec4 back = v.toEye * *eyePosition(v);
        EXPECT_LT(glm::length(glm::dvec3(back)), 1e-8);
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double z : {0.0, 1e-18, nan, std::numeric_limits<double>::infinity()}) {
        View v;
        v.projection = glm::perspective(1.0, 1.0, 1.0, 10.0);
        v.toEye = glm::dmat4(1.0);
        v.toEye[2] = glm::dvec4(1.0, 0.0, z, 0.0); // almost the first column
        EXPECT_EQ(viewDirectionAt(v, glm::dvec3(0.0)).status.code, ErrorCode::SINGULAR_MATRIX) << z;
        EXPECT_EQ(closestAxis(v, glm::dvec3(0.0), glm::dvec3(1.0)).status.code,
                  ErrorCode::SINGULAR_MATRIX);
    }
    View v;
    v.projection = glm::dmat4(0.0);
    EXPECT_EQ(eyePosition(v).status.code, ErrorCode::SINGULAR_MATRIX);
    EXPECT_EQ(nearFar(v.projection).status.code, ErrorCode::SINGULAR_MATRIX);
}

TEST(ViewHelpers, ClosestAxisIsMeasuredInVoxels)
{
    View v = lookFrom(glm::dvec3(0, 0, 50), glm::dvec3(0, 30, 0));
    EXPECT_EQ(closestAxis(v, glm::dvec3(0, 30, 0), glm::dvec3(1.0))->axis, 2);
    EXPECT_EQ(closestAxis(v, glm::dvec3(0, 30, 0), glm::dvec3(1.0))->sign, -1);
    // Voxels that are five times as long along z: fewer of them in the way.
    EXPECT_EQ(closestAxis(v, glm::dvec3(0, 30, 0), glm::dvec3(1, 1, 5))->axis, 1);
    EXPECT_EQ(closestAxis(v, glm::dvec3(0, 30, 0), glm::dvec3(1, 1, 5))->sign, 1);
}

TEST(ViewHelpers, NearAndFar)
{
    const NearFar p = *nearFar(glm::frustum(-0.1, 0.7, -0.2, 0.1, 0.5, 90.0));
    EXPECT_NEAR(p.nearDepth, 0.5, 1e-13);
    EXPECT_NEAR(p.farDepth, 90.0, 1e-11);
    const NearFar o = *nearFar(glm::ortho(-1.0, 1.0, -1.0, 1.0, -7.0, 9.0));
    EXPECT_NEAR(o.nearDepth, -7.0, 1e-13);
    EXPECT_NEAR(o.farDepth, 9.0, 1e-13);
    EXPECT_TRUE(std::isinf(nearFar(glm::infinitePerspective(1.0, 1.0, 0.25))->farDepth));
}

TEST(ViewHelpers, LastRowMayBeOffByRounding)
{
    View v;
    v.toEye = glm::lookAt(glm::dvec3(300, -200, 100), glm::dvec3(0.0), glm::dvec3(0, 0, 1));
    v.projection = glm::perspective(1.0, 1.0, 1.0, 1000.0);
    const glm::dmat4 exact = *fromEye(v);
    v.toEye[0][3] = 1e-16;
    v.toEye[2][3] = -1e-16;
    v.toEye[3][3] = std::nextafter(1.0, 2.0);
    const Result<glm::dmat4> inverse = fromEye(v);
    ASSERT_TRUE(inverse.ok());
    EXPECT_EQ(*inverse, exact);
    EXPECT_TRUE(eyePosition(v).ok());
    // Inverted twice, as scene graphs do.
    v.toEye = glm::inverse(glm::inverse(v.toEye));
    EXPECT_TRUE(fromEye(v).ok());
    // In proportion to the model's scale.
    v.toEye = glm::scale(glm::dmat4(1.0), glm::dvec3(1e-8));
    v.toEye[1][3] = 1e-24;
    EXPECT_TRUE(fromEye(v).ok());
    v.toEye[1][3] = 1e-20;
    EXPECT_FALSE(fromEye(v).ok());
    v.toEye[1][3] = std::nan("");
    EXPECT_FALSE(fromEye(v).ok());
    v = View();
    v.toEye[3][3] = 1.001;
    EXPECT_FALSE(fromEye(v).ok());
}

} // namespace ViewHelpersTest
