// The whole scene under osg::ClipControl, with a projection to the clip space that it asks for: the
// same picture as without.

#include <render/Volumes.h>
#include <support/GLTest.h>
#include <support/Shapes.h>

#include <osg/ClipControl>

namespace ClipControlTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using osg::ClipControl;
using support::FloatImage;
using support::RenderOptions;

namespace {

RenderOptions view()
{
    RenderOptions options = RenderOptions().size(80, 80).perspective(45.0).lookAt(
        {40, -20, 30}, {12, 10, 8}, {0, 0, 1});
    options.projection.makePerspective(45.0, 1.0, 10.0, 100.0);
    options.computeNearFar = false;
    return options;
}

enum Content
{
    SLABS = 1,
    SLICES = 2,
    MAXIMUM = 4,
    OVERLAP = 8,
    OPAQUE = 16,
    TRANSLUCENT = 32
};

osg::ref_ptr<osg::Group> makeScene(int content)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<Voxels> voxels = makeVoxels({25, 21, 17}, bumps);
    const auto add = [&](VolumeAppearance::Technique technique, double opacity) {
        const TwinVolume twin = makeTwin(voxels, smoothPoints(opacity), technique);
        if (content & MAXIMUM) twin.node->setRayFunction(VolumeAppearance::MAXIMUM);
        scene->addChild(twin.node);
    };
    add(content & SLICES ? VolumeAppearance::SLICES : VolumeAppearance::SLABS, 0.1);
    if (content & OVERLAP) add(VolumeAppearance::SLABS, 0.07);
    const auto quad = [&](const std::array<osg::Vec3, 4>& corners, const osg::Vec4& color) {
        scene->addChild(support::makeQuad(corners, color, color.a() < 1.0f));
    };
    if (content & OPAQUE)
        quad({osg::Vec3(-5, 2, -5), {30, 8, 2}, {28, 14, 20}, {-4, 12, 18}}, {0.2f, 0.7f, 0.3f, 1});
    if (content & TRANSLUCENT)
        quad({osg::Vec3(-5, 15, -5), {30, 3, 0}, {28, 8, 20}, {-4, 18, 18}},
             {0.8f, 0.3f, 0.1f, 0.5f});
    return scene;
}

class ClipControls : public support::GLTest, public ::testing::WithParamInterface<int>
{
};

TEST_P(ClipControls, ShowTheSamePicture)
{
    const FloatImage expected = support::renderScene(makeScene(GetParam()), view());
    EXPECT_GT(support::coveredPixels(expected, 0.02f).count(), 800u);
    for (const auto origin : {ClipControl::LOWER_LEFT, ClipControl::UPPER_LEFT})
        for (const auto depth : {ClipControl::NEGATIVE_ONE_TO_ONE, ClipControl::ZERO_TO_ONE}) {
            const osg::ref_ptr<osg::Group> scene = makeScene(GetParam());
            scene->getOrCreateStateSet()->setAttributeAndModes(new ClipControl(origin, depth));
            RenderOptions options = view();
            const bool flipped = origin == ClipControl::UPPER_LEFT;
            if (flipped) options.projection.postMultScale(osg::Vec3d(1.0, -1.0, 1.0));
            if (depth == ClipControl::ZERO_TO_ONE) {
                options.projection.postMultScale(osg::Vec3d(1.0, 1.0, 0.5));
                options.projection.postMultTranslate(osg::Vec3d(0.0, 0.0, 0.5));
            }
            support::SceneRenderer renderer(scene, options);
            const support::Difference d = compare(renderer.render(), expected);
            EXPECT_EQ(renderer.glError(), 0u);
            EXPECT_LE(d.rmse, 1e-5) << flipped << " " << depth;
            EXPECT_LE(d.maximum, 1e-3);
        }
}

INSTANTIATE_TEST_SUITE_P(Contents, ClipControls,
                         ::testing::Values(SLABS, SLICES, SLABS | MAXIMUM, SLABS | OVERLAP,
                                           SLABS | OPAQUE, SLICES | OPAQUE, SLABS | TRANSLUCENT,
                                           SLABS | OVERLAP | TRANSLUCENT, SLICES | TRANSLUCENT));

} // namespace

} // namespace ClipControlTest
