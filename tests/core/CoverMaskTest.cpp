#include <osgVolumizer/core/ordering/CoverMask.h>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace CoverMaskTest {

using namespace osgVolumizer::core;

namespace {

const glm::ivec2 PIXELS(150, 70);

glm::dmat4 view(const glm::dvec3& eye, const glm::dvec3& at)
{
    return glm::perspective(0.7, double(PIXELS.x) / PIXELS.y, 0.5, 1000.0) *
           glm::lookAt(eye, at, glm::dvec3(0.02, 0.1, 1.0));
}

// Whether the ray of a pixel meets a box.
bool meets(const glm::dmat4& toClip, const glm::ivec2& pixel, const Box3d& box)
{
    const glm::dvec2 ndc = (glm::dvec2(pixel) + 0.5) / glm::dvec2(PIXELS) * 2.0 - 1.0;
    const glm::dmat4 back = glm::inverse(toClip);
    const glm::dvec4 nearEnd = back * glm::dvec4(ndc, -1.0, 1.0);
    const glm::dvec4 farEnd = back * glm::dvec4(ndc, 1.0, 1.0);
    const glm::dvec3 origin = glm::dvec3(nearEnd) / nearEnd.w;
    const glm::dvec3 along = glm::dvec3(farEnd) / farEnd.w - origin;
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - origin[axis]) / along[axis];
        const double b = (box.max[axis] - origin[axis]) / along[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
}

Box3d grown(const Box3d& box, double margin)
{
    return {box.min - margin, box.max + margin};
}

} // namespace

// Small boxes within a pixel of the view tell of each pixel whether it is covered.
TEST(CoverMask, CoversThePixelsWhoseRaysMeetTheBox)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto point = [&](double scale) {
        return scale * glm::dvec3(uniform(random), uniform(random), uniform(random));
    };
    int covered = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const glm::dmat4 toClip = view(glm::dvec3(0.0, -9.0, 0.0) + point(2.0), point(1.0));
        Box3d box;
        box.expand(point(2.0));
        box.expand(point(2.0));
        CoverMask mask(toClip, PIXELS);
        mask.add(box);
        const glm::dmat4 back = glm::inverse(toClip);
        for (int y = 0; y < PIXELS.y; y += 3)
            for (int x = 0; x < PIXELS.x; ++x) {
                const glm::dvec2 ndc = (glm::dvec2(x, y) + 0.5) / glm::dvec2(PIXELS) * 2.0 - 1.0;
                const glm::dvec4 p = back * glm::dvec4(ndc, 0.97, 1.0);
                const glm::dvec3 at = glm::dvec3(p) / p.w;
                // The rectangle around a point between four pixels is those four.
                const bool known = mask.covers({at, at});
                const bool inner = meets(toClip, {x, y}, grown(box, -1e-9));
                const bool outer = meets(toClip, {x, y}, grown(box, 1e-9));
                if (known) {
                    EXPECT_TRUE(outer) << x << " " << y;
                }
                covered += inner;
                // Where its neighbours are covered too, so is it.
                bool all = inner;
                for (const glm::ivec2 d : {glm::ivec2(1, 0),
                                           {-1, 0},
                                           {0, 1},
                                           {0, -1},
                                           glm::ivec2(1, 1),
                                           {-1, -1},
                                           {1, -1},
                                           {-1, 1}}) {
                    const glm::ivec2 other =
                        glm::clamp(glm::ivec2(x, y) + d, glm::ivec2(0), PIXELS - 1);
                    all = all && meets(toClip, other, grown(box, -1e-9));
                }
                if (all) {
                    EXPECT_TRUE(known) << x << " " << y;
                }
            }
    }
    EXPECT_GT(covered, 2000);
}

TEST(CoverMask, BoxesThatShareFacesLeaveNoGap)
{
    std::mt19937 random(8);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int trial = 0; trial < 60; ++trial) {
        const glm::dvec3 eye(uniform(random), -7.0, trial % 3 == 0 ? 0.0 : uniform(random));
        CoverMask mask(view(eye, glm::dvec3(0.0)), PIXELS);
        const int n = 2 + trial % 5;
        for (int i = 0; i < n * n * n; ++i) {
            const glm::dvec3 low = glm::dvec3(i % n, i / n % n, i / n / n) * (2.0 / n) - 1.0;
            mask.add({low, low + 2.0 / n});
        }
        // Of a larger one behind, what lies in the middle.
        EXPECT_TRUE(mask.covers({{-0.8, 2.0, -0.8}, {0.8, 3.0, 0.8}})) << trial;
        EXPECT_FALSE(mask.covers({{-2.0, 2.0, -2.0}, {2.0, 3.0, 2.0}})) << trial;
    }
}

TEST(CoverMask, NothingIsKnownOfWhatLiesBeforeTheNearPlane)
{
    CoverMask mask(view({0, -5, 0}, {0, 0, 0}), PIXELS);
    mask.add({{-50.0, -8.0, -50.0}, {50.0, 0.0, 50.0}}); // around the eye
    EXPECT_FALSE(mask.covers({{-0.1, 2.0, -0.1}, {0.1, 2.1, 0.1}}));
    mask.add({{-50.0, 0.0, -50.0}, {50.0, 1.0, 50.0}});
    EXPECT_TRUE(mask.covers({{-0.1, 2.0, -0.1}, {0.1, 2.1, 0.1}}));
    EXPECT_TRUE(mask.covers({{-1e3, 2.0, -1e3}, {1e3, 2.1, 1e3}})) << "beyond the window";
    EXPECT_FALSE(mask.covers({{-0.1, -8.0, -0.1}, {0.1, 2.1, 0.1}}));
    EXPECT_FALSE(mask.covers({{400.0, 2.0, -0.1}, {401.0, 2.1, 0.1}})) << "outside the window";
    EXPECT_FALSE(mask.covers({glm::dvec3(NAN), glm::dvec3(NAN)}));
    EXPECT_FALSE(mask.covers(Box3d()));
}

} // namespace CoverMaskTest
