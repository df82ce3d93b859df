// What is under a pixel, by the depth that was drawn, is what the scene says.

#include "MixedScene.h"
#include "Volumes.h"

#include <osgVolumizer/interact/DrawnDepth.h>

#include <osg/ShapeDrawable>

#include <support/GLTest.h>

namespace DrawnDepthTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::RenderOptions;

namespace {

class DrawnDepths : public support::GLTest
{
};

} // namespace

TEST_F(DrawnDepths, TellWhatIsUnderAPixel)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(
        makeVoxels(glm::ivec3(25), [](const glm::dvec3& p) { return p.x < 12.0 ? 0.9 : 0.0; }));
    volume->setLookupTable(makeTable(smoothPoints(0.6)));
    scene->addChild(volume);
    // A wall behind the volume, larger than it, and a ball in front of its left half.
    scene->addChild(makeGeometry(
        quadMesh({glm::vec3(-20, 30, -20), {44, 30, -20}, {44, 30, 44}, {-20, 30, 44}}),
        {0.2f, 0.5f, 0.9f, 1.0f}, true));
    scene->addChild(new osg::ShapeDrawable(new osg::Sphere({4, -8, 4}, 3.0f)));
    support::SceneRenderer renderer(scene, RenderOptions().size(90, 80).perspective(35.0).lookAt(
                                               {12, -70, 12}, {12, 12, 12}, {0, 0, 1}));
    osg::Camera& camera = *renderer.viewer().getCamera();
    const osg::ref_ptr<DrawnDepth> depth = DrawnDepth::install(camera);
    renderer.render();
    EXPECT_FALSE(depth->get()); // nobody asked
    int volumes = 0, walls = 0, none = 0;
    for (int y = 1; y < 80; y += 6)
        for (int x = 1; x < 90; x += 6) {
            depth->ask(x + 0.5, y + 0.5);
            EXPECT_FALSE(depth->get());
            renderer.render();
            ASSERT_TRUE(depth->get());
            const auto drawn = zpickDrawn(camera, x + 0.5, y + 0.5, *depth->get());
            const auto exact = zpick(camera, x + 0.5, y + 0.5);
            ASSERT_TRUE(drawn.ok() && exact.ok());
            ASSERT_EQ(drawn.value.has_value(), exact.value.has_value()) << x << " " << y;
            if (!exact.value) {
                ++none;
                continue;
            }
            ASSERT_EQ((*drawn)->isVolume, (*exact)->isVolume) << x << " " << y;
            // Depth buffers are less exact, and balls of triangles are no balls.
            EXPECT_LT(((*drawn)->point - (*exact)->point).length(),
                      (*exact)->isVolume ? 1e-6 : 0.3);
            EXPECT_NEAR((*drawn)->ratio, (*exact)->ratio, 0.01);
            ++((*exact)->isVolume ? volumes : walls);
        }
    EXPECT_GT(volumes, 10);
    EXPECT_GT(walls, 30);
    EXPECT_GT(none, 0);
    depth->ask(1000, 1);
    renderer.render();
    EXPECT_FALSE(depth->get());
    EXPECT_EQ(zpickDrawn(camera, 1, 1, 1.5).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(zpickDrawn(camera, 1, 1, std::nan("")).status.code, ErrorCode::VALUE_INVALID);
}

} // namespace DrawnDepthTest
