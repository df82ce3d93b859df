#include <osgVolumizer/render/draw/PixelRays.h>

#include <gtest/gtest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <utility>
#include <vector>

namespace PixelRaysTest {

using namespace osgVolumizer;
using render::PixelRays;
using render::pixelRays;

namespace {

const glm::dvec4 VIEWPORT(30.0, 20.0, 200.0, 100.0);

glm::dmat4 someView()
{
    glm::dmat4 view = glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, -0.2, -20.0));
    view = glm::rotate(view, 0.7, glm::dvec3(1.0, 2.0, -0.5));
    return glm::scale(view, glm::dvec3(1.5, 0.7, -2.0)); // mirrored
}

std::vector<glm::dmat4> projections()
{
    return {glm::perspective(0.8, 2.0, 1.0, 100.0), glm::ortho(-8.0, 12.0, -6.0, 4.0, 1.0, 100.0),
            glm::frustum(-0.3, 1.1, -0.2, 0.5, 1.0, 100.0)};
}

// Where the ray of a pixel is, in a frame, at t.
glm::dvec3 along(const glm::dmat3& origin, const glm::dmat3& direction, const glm::dvec3& window,
                 double t)
{
    return origin * window + t * (direction * window);
}

} // namespace

TEST(PixelRays, AreWhereTheProjectionPutsTheirPixel)
{
    const double reference = 19.0;
    for (const glm::dmat4& projection : projections()) {
        const Result<PixelRays> rays =
            pixelRays(someView(), projection, VIEWPORT, reference, glm::dvec3(0.0));
        ASSERT_TRUE(rays.ok());
        for (const glm::dvec2& pixel :
             {glm::dvec2(30.5, 20.5), glm::dvec2(229.5, 119.5), glm::dvec2(77.25, 90.0)})
            for (const double t : {-9.0, 0.0, 40.0}) {
                const glm::dvec3 window(pixel - rays->windowCenter, 1.0);
                const glm::dvec3 eye = along(rays->originEye, rays->directionEye, window, t);
                EXPECT_NEAR(-eye.z, reference + t, 1e-9);
                const glm::dvec4 clip = projection * glm::dvec4(eye, 1.0);
                const glm::dvec2 back =
                    glm::dvec2(VIEWPORT) +
                    0.5 * (glm::dvec2(clip) / clip.w + 1.0) * glm::dvec2(VIEWPORT.z, VIEWPORT.w);
                EXPECT_NEAR(glm::length(back - pixel), 0.0, 1e-9);
                // The frame's ray is the same one, and so are clip z and w.
                const glm::dvec3 frame = along(rays->origin, rays->direction, window, t);
                const glm::dvec3 same(someView() * glm::dvec4(frame, 1.0));
                EXPECT_NEAR(glm::length(same - eye), 0.0, 1e-9);
                EXPECT_NEAR(glm::dot(rays->clipZOrigin, window) +
                                t * glm::dot(rays->clipZDirection, window),
                            clip.z, 1e-9);
                EXPECT_NEAR(glm::dot(rays->clipWOrigin, window) +
                                t * glm::dot(rays->clipWDirection, window),
                            clip.w, 1e-9);
            }
    }
}

TEST(PixelRays, CountFromThePixelOfTheCenterInsideTheViewport)
{
    const glm::dmat4 projection = projections()[0], toEye = someView();
    const glm::dvec4 clip = projection * toEye * glm::dvec4(1.0, 1.0, 1.0, 1.0);
    const glm::dvec2 window = glm::dvec2(VIEWPORT) + 0.5 * (glm::dvec2(clip) / clip.w + 1.0) *
                                                         glm::dvec2(VIEWPORT.z, VIEWPORT.w);
    const auto near = pixelRays(toEye, projection, VIEWPORT, 19.0, glm::dvec3(1.0));
    ASSERT_TRUE(near.ok());
    EXPECT_LE(std::abs(near->windowCenter.x - window.x), 0.5);
    EXPECT_LE(std::abs(near->windowCenter.y - window.y), 0.5);
    for (const glm::dvec3& far : {glm::dvec3(1e6), glm::dvec3(-1e6, 1e5, 0.0)}) {
        const auto rays = pixelRays(toEye, projection, VIEWPORT, 19.0, far);
        ASSERT_TRUE(rays.ok());
        EXPECT_GE(rays->windowCenter.x, VIEWPORT.x);
        EXPECT_LE(rays->windowCenter.x, VIEWPORT.x + VIEWPORT.z + 0.5);
        EXPECT_GE(rays->windowCenter.y, VIEWPORT.y);
        EXPECT_LE(rays->windowCenter.y, VIEWPORT.y + VIEWPORT.w + 0.5);
    }
}

TEST(PixelRays, AreRefusedWhereThereAreNone)
{
    const glm::dmat4 good = projections()[0];
    const auto code = [](const glm::dmat4& toEye, const glm::dmat4& projection) {
        return pixelRays(toEye, projection, VIEWPORT, 19.0, glm::dvec3(0.0)).status.code;
    };
    EXPECT_EQ(code(glm::scale(glm::dmat4(1.0), glm::dvec3(1, 0, 1)), good),
              ErrorCode::SINGULAR_MATRIX);
    glm::dmat4 flat = good;
    flat[0][0] = 0.0;
    EXPECT_EQ(code(someView(), flat), ErrorCode::SINGULAR_MATRIX);
    glm::dmat4 keystone = good;
    keystone[0][3] = 0.1;
    EXPECT_EQ(code(someView(), keystone), ErrorCode::NOT_SUPPORTED);
}

} // namespace PixelRaysTest
