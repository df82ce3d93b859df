// Volumes that paint others: a dose over anatomy.

#include "MixedScene.h"

#include <support/GLTest.h>

namespace MergePaintTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis
const Points WARM = {{0.0, {0.1, 0.3, 0.9, 0.02}}, {1.0, {1.0, 0.4, 0.1, 0.2}}};
const Points COLD = {{0.0, {0.1, 0.9, 0.3, 0.01}}, {1.0, {0.2, 0.2, 1.0, 0.25}}};
/// Of paint, whose opacity is how much of the other colour it takes away. Not 0 at the region's
/// ends.
const Points DOSE = {{0.0, {0.9, 0.8, 0.3, 0.3}}, {1.0, {1.0, 0.1, 0.05, 1.0}}};

class MergePaint : public support::GLTest
{
protected:
    MergePaint()
    {
        _options.size(128, 128).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    }
    static osg::Matrixd turned(double x, double y, double z)
    {
        return osg::Matrixd::rotate(0.5, osg::Vec3d(0.3, 1.0, 0.5)) *
               osg::Matrixd::translate(x, y, z);
    }
    static void addPaint(MixedScene& scene, const osg::Matrixd& placement = turned(9, 4, 6))
    {
        scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.5), DOSE, placement)
            .setCombineRule(VolumeAppearance::PAINT);
        scene.truth().volumes.back().paint = true;
    }
    /// The error at period 1, and how it falls with the period.
    void expectSecondOrder(MixedScene& scene, const std::string& name) const
    {
        std::vector<double> periods, errors;
        for (double period : {2.0, 1.0, 0.5}) {
            scene.setPeriod(period);
            const Judged j = judge(scene, _options);
            periods.push_back(period);
            errors.push_back(j.away.rmse);
            std::printf("  %s, period %g: rmse %.2e\n", name.c_str(), period, j.away.rmse);
            if (period != 1.0) continue;
            EXPECT_LE(j.all.rmse, 4e-3);
            EXPECT_GT(j.away.pixels, 2000u);
            save(j, "merge_paint_" + name);
        }
        EXPECT_GE(support::convergenceOrder(periods, errors), 1.9);
    }

    RenderOptions _options;
};

TEST_F(MergePaint, OneOverAnother)
{
    MixedScene scene;
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM);
    addPaint(scene);
    expectSecondOrder(scene, "one");
}

// Slices are of first order, painted or not.
TEST_F(MergePaint, SlicesAreAsGoodAsUnpainted)
{
    MixedScene scene;
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM)
        .setTechnique(VolumeAppearance::SLICES);
    const Judged plain = judge(scene, _options);
    addPaint(scene);
    const Judged painted = judge(scene, _options);
    save(painted, "merge_paint_slices");
    EXPECT_LE(painted.away.rmse, plain.away.rmse);
    EXPECT_LE(painted.all.rmse, plain.all.rmse);
    EXPECT_GT(support::compare(painted.picture, plain.picture).maximum, 0.1);
}

TEST_F(MergePaint, Preintegrated)
{
    MixedScene scene;
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM)
        .setLookup(VolumeAppearance::PREINTEGRATED);
    addPaint(scene);
    scene.setPeriod(1.0);
    const Judged j = judge(scene, _options);
    EXPECT_LE(j.all.rmse, 4e-3);
}

TEST_F(MergePaint, OverTwoVolumesAndSurfaces)
{
    MixedScene scene;
    scene.addVolume(makeBlob(glm::ivec3(SIZE), 7.5), WARM);
    scene.addMesh(sphereMesh({16, 16, 16}, 9.0, 24, 12), {0.1, 0.9, 0.2, 0.5});
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), COLD, turned(-4, 8, 3));
    addPaint(scene);
    expectSecondOrder(scene, "scene");
}

// What is painted twice is painted in any order, and nodes may stand in any order.
TEST_F(MergePaint, OrderDoesNotMatter)
{
    MixedScene scene;
    addPaint(scene);
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM);
    addPaint(scene, turned(2, 9, -5));
    const Judged j = judge(scene, _options);
    save(j, "merge_paint_twice");
    EXPECT_LE(j.all.rmse, 4e-3);
    scene.reverse();
    EXPECT_LE(support::compare(support::renderScene(scene.root(), _options), j.picture).maximum,
              1e-5);
}

TEST_F(MergePaint, InvisibleByItself)
{
    MixedScene paint, plain, beside;
    addPaint(paint);
    EXPECT_EQ(support::coveredPixels(support::renderScene(paint.root(), _options)).count(), 0u);
    plain.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM);
    beside.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM);
    addPaint(beside, osg::Matrixd::scale(0.3, 0.3, 0.3) * osg::Matrixd::translate(40, 12, 12));
    RenderOptions options = _options; // whose near and far planes do not depend on the scene
    options.computeNearFar = false;
    options.projection = osg::Matrixd::perspective(40.0, 1.0, 20.0, 300.0);
    const FloatImage one = support::renderScene(plain.root(), options);
    EXPECT_EQ(support::compare(support::renderScene(beside.root(), options), one).maximum, 0.0);
}

// Opacity is left alone, and fully opaque black paint leaves nothing but it.
TEST_F(MergePaint, TakesColorOnly)
{
    MixedScene plain, painted;
    plain.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), constantPoints({0.8, 0.6, 0.4, 0.1}));
    painted.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), constantPoints({0.8, 0.6, 0.4, 0.1}));
    VolumeAppearance& paint =
        painted.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), constantPoints({0, 0, 0, 1}),
                          osg::Matrixd::scale(3, 3, 3) * osg::Matrixd::translate(-30, -30, -30));
    paint.setCombineRule(VolumeAppearance::PAINT);
    const FloatImage before = support::renderScene(plain.root(), _options);
    const FloatImage after = support::renderScene(painted.root(), _options);
    ASSERT_GT(support::coveredPixels(before).count(), 2000u);
    for (std::size_t i = 0; i < before.pixels.size(); ++i) {
        ASSERT_NEAR(after.pixels[i].a, before.pixels[i].a, 1e-5) << i;
        ASSERT_LE(after.pixels[i].r + after.pixels[i].g + after.pixels[i].b, 1e-6) << i;
    }
}

} // namespace

} // namespace MergePaintTest
