// Views that move and are to keep a frame time: fewer rays and samples, the same picture but for
// detail, and the exact one once they rest.

#include "MixedScene.h"

#include <support/GLTest.h>
#include <support/Hooks.h>

namespace MovingViewsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33;
const glm::dvec4 GLASS(0.2, 0.3, 1.0, 0.5), STEEL(0.7, 0.7, 0.8, 1.0);

/// Turns the view a little for each frame.
RenderOptions viewAt(double angleDegrees, int width, int height)
{
    const double a = osg::DegreesToRadians(angleDegrees);
    return RenderOptions()
        .size(width, height)
        .perspective(40.0)
        .lookAt({16 + 75 * std::cos(a), 16 + 75 * std::sin(a), 40}, {16, 16, 16}, {0, 0, 1});
}

class MovingViews : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _volume = &_scene.addVolume(makeBlob(glm::ivec3(SIZE), 6.0), smoothPoints(0.1));
    }

    void addSurfaces()
    {
        _scene.addQuad({glm::vec3(-5, 10, -5), {38, 10, -5}, {38, 20, 38}, {-5, 20, 38}}, GLASS);
    }
    void addPin()
    {
        _scene.addQuad({glm::vec3(14, -30, 14), {18, -30, 14}, {18, 60, 17}, {14, 60, 17}}, STEEL,
                       true);
    }

    /// The picture of the frame in which the view has just arrived, with so many times fewer
    /// samples.
    FloatImage moving(support::SceneRenderer& renderer, double reduction)
    {
        support::viewHooks(renderer.viewer()).reduction = reduction;
        const RenderOptions end = renderer.options();
        renderer.options() = viewAt(31.0, end.width, end.height);
        renderer.render();
        renderer.options() = end;
        return renderer.render();
    }

    MixedScene _scene;
    VolumeAppearance* _volume = nullptr;
};

double meanAbsolute(const FloatImage& a)
{
    double sum = 0.0;
    for (const glm::vec4& p : a.pixels)
        sum += std::abs(p.r) + std::abs(p.g) + std::abs(p.b);
    return sum / (3.0 * static_cast<double>(a.pixels.size()));
}

TEST_F(MovingViews, LookAlikeAndAreExactAtRest)
{
    for (const int surfaces : {0, 1, 2}) {
        if (surfaces == 1) addSurfaces();
        if (surfaces == 2) addPin();
        // Sizes that are no multiples of any distance between rays.
        for (const auto& size : {std::pair<int, int>{128, 96}, {127, 61}}) {
            ASSERT_TRUE(_volume->setTargetFrameTime(0.0));
            const RenderOptions options = viewAt(30.0, size.first, size.second);
            const FloatImage exact = support::renderScene(_scene.root(), options);
            ASSERT_TRUE(_volume->setTargetFrameTime(0.05));
            support::SceneRenderer renderer(_scene.root(), options);
            // A sixteenth of the samples; outlines of surfaces in the volume are one ray wide.
            const FloatImage moved = moving(renderer, 16.0);
            support::savePicture(moved, "moving_" + std::to_string(surfaces));
            const support::Difference difference = support::compare(moved, exact);
            EXPECT_GT(difference.maximum, 1e-3) << surfaces; // that is, samples were saved
            EXPECT_LT(difference.rmse, surfaces == 0 ? 0.006 : 0.08) << surfaces;
            EXPECT_NEAR(meanAbsolute(moved), meanAbsolute(exact),
                        (surfaces == 0 ? 0.003 : 0.04) * meanAbsolute(exact));
            EXPECT_EQ(renderer.glError(), 0u);
            renderer.render();
            EXPECT_EQ(support::compare(renderer.render(), exact).maximum, 0.0) << surfaces;
        }
    }
}

// Volumes that overlap are one march, which has fewer rays too.
TEST_F(MovingViews, VolumesThatOverlap)
{
    _scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.0), smoothPoints(0.2),
                     osg::Matrixd::translate(6, -5, 4));
    const RenderOptions options = viewAt(30.0, 127, 61);
    const FloatImage exact = support::renderScene(_scene.root(), options);
    for (const auto& volume : _scene.volumes())
        ASSERT_TRUE(volume->setTargetFrameTime(0.05));
    support::SceneRenderer renderer(_scene.root(), options);
    const FloatImage moved = moving(renderer, 16.0);
    support::savePicture(moved, "moving_overlap");
    const support::Difference difference = support::compare(moved, exact);
    EXPECT_GT(difference.maximum, 1e-3); // that is, samples were saved
    EXPECT_LT(difference.rmse, 0.006);
    EXPECT_EQ(renderer.glError(), 0u);
    renderer.render();
    EXPECT_EQ(support::compare(renderer.render(), exact).maximum, 0.0);
}

TEST_F(MovingViews, KeepTheEdgesOfOpaqueGeometry)
{
    // In front of the volume, steel stays what it is, up to its outline; behind and in it, nothing
    // of the volume in front of it is lost.
    _scene.addQuad({glm::vec3(50, 30, 10), {50, 30, 30}, {42, 44, 30}, {42, 44, 10}}, STEEL, true);
    addPin();
    const RenderOptions options = viewAt(30.0, 128, 96);
    const FloatImage exact = support::renderScene(_scene.root(), options);
    _volume->setNodeMask(0);
    const FloatImage bare = support::renderScene(_scene.root(), options);
    _volume->setNodeMask(~0u);
    ASSERT_TRUE(_volume->setTargetFrameTime(0.05));
    support::SceneRenderer renderer(_scene.root(), options);
    const FloatImage moved = moving(renderer, 128.0);
    support::savePicture(moved, "moving_opaque");
    support::Mask steel{128, 96, std::vector<unsigned char>(moved.pixels.size(), 0)};
    for (std::size_t i = 0; i < moved.pixels.size(); ++i)
        steel.set[i] = bare.pixels[i].a > 0.5f && exact.pixels[i] == bare.pixels[i];
    EXPECT_GT(steel.count(), 200u);
    // Its very outline may have a ray beside it that saw past it.
    EXPECT_LT(support::compare(moved, exact, support::eroded(steel, 1)).maximum, 1e-4);
    EXPECT_LT(support::compare(moved, exact, steel).rmse, 0.02);
}

TEST_F(MovingViews, ErrorsFallWithTheReduction)
{
    const RenderOptions options = viewAt(30.0, 128, 96);
    const FloatImage exact = support::renderScene(_scene.root(), options);
    ASSERT_TRUE(_volume->setTargetFrameTime(0.05));
    std::vector<double> errors;
    for (const double reduction : {2.0, 16.0, 64.0}) {
        support::SceneRenderer renderer(_scene.root(), options);
        errors.push_back(support::compare(moving(renderer, reduction), exact).rmse);
    }
    EXPECT_LT(errors[0], errors[1]);
    EXPECT_LT(errors[1], errors[2]);
}

TEST_F(MovingViews, OnlyWhatIsMarchedAtOnceHasFewerRays)
{
    // Gathered values, and slices, have longer periods alone; nothing of them is lost either.
    const RenderOptions options = viewAt(30.0, 96, 96);
    for (const auto function : {VolumeAppearance::MAXIMUM, VolumeAppearance::AVERAGE}) {
        _volume->setRayFunction(function);
        ASSERT_TRUE(_volume->setTargetFrameTime(0.0));
        const FloatImage exact = support::renderScene(_scene.root(), options);
        ASSERT_TRUE(_volume->setTargetFrameTime(0.05));
        support::SceneRenderer renderer(_scene.root(), options);
        EXPECT_LT(support::compare(moving(renderer, 64.0), exact).rmse, 0.1);
    }
    _volume->setRayFunction(VolumeAppearance::COMPOSITE);
    _volume->setTechnique(VolumeAppearance::SLICES);
    ASSERT_TRUE(_volume->setTargetFrameTime(0.0));
    const FloatImage exact = support::renderScene(_scene.root(), options);
    ASSERT_TRUE(_volume->setTargetFrameTime(0.05));
    support::SceneRenderer renderer(_scene.root(), options);
    EXPECT_LT(support::compare(moving(renderer, 64.0), exact).rmse, 0.1);
}

} // namespace

} // namespace MovingViewsTest
