// Every kind of view: off-axis, sheared, mirrored, from inside, with the volume partly behind the
// eye.

#include "Volumes.h"

#include <support/GLTest.h>

#include <osg/MatrixTransform>

namespace ViewsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

class Views : public support::GLTest,
              public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        osg::ref_ptr<Voxels> voxels = makeVoxels({25, 21, 17}, bumps);
        ASSERT_TRUE(voxels->setBrickSize({13, 13, 13}));
        _twin = makeTwin(voxels, smoothPoints(0.03), GetParam());
        _twin.setPeriod(0.25);
        _options.size(80, 72).perspective(45.0).lookAt({40, -20, 30}, {12, 10, 8}, {0, 0, 1});
    }

    void expectOracle(const std::string& name, const osg::Matrixd& model = osg::Matrixd(),
                      double nearDepth = -1.0)
    {
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(model);
        transform->addChild(_twin.node);
        oracle::Scene scene = oracleScene(_twin.oracle);
        scene.volumes[0].objectToWorld = support::toGlm(model);
        oracle::Camera camera = support::oracleCamera(_options);
        if (nearDepth > 0.0) camera.nearDepth = nearDepth;
        support::SceneRenderer renderer(transform, _options);
        const FloatImage image = renderer.render();
        EXPECT_EQ(renderer.glError(), 0u);
        const FloatImage expected = oracle::render(scene, camera);
        support::savePicture(image, "views_" + name + std::to_string(GetParam()));
        support::savePicture(expected, "views_" + name + "_oracle");
        EXPECT_GT(support::coveredPixels(expected, 0.05f).count(), 700u) << name;
        const support::Difference d = compare(image, expected);
        EXPECT_LE(d.rmse, 2e-3) << name << ", maximum " << d.maximum << " at " << d.worstX << " "
                                << d.worstY;
    }

    TwinVolume _twin;
    RenderOptions _options;
};

TEST_P(Views, Orthographic)
{
    _options.orthographic(20.0);
    expectOracle("orthographic");
}

TEST_P(Views, OffAxis)
{
    _options.projection.makeFrustum(-0.2, 0.9, -0.7, 0.3, 1.0, 1000.0);
    expectOracle("off_axis");
    _options.projection.makeOrtho(-14.0, 24.0, -8.0, 22.0, 1.0, 1000.0);
    expectOracle("off_axis_orthographic");
}

TEST_P(Views, Sheared)
{
    // As for a screen that is not looked at straight: eye x and y move with depth.
    osg::Matrixd shear;
    shear(2, 0) = 0.3;
    shear(2, 1) = -0.2;
    const osg::Matrixd perspective = _options.projection;
    _options.projection = shear * perspective;
    _options.view = _options.view * osg::Matrixd::translate(14.0, -9.0, 0.0);
    expectOracle("sheared");
    _options.orthographic(20.0);
    _options.projection = shear * _options.projection;
    expectOracle("sheared_orthographic");
    // Turned about the view axis, after projecting.
    _options.lookAt({40, -20, 30}, {12, 10, 8}, {0, 0, 1});
    _options.projection = perspective * osg::Matrixd::rotate(0.5, osg::Vec3d(0, 0, 1));
    expectOracle("rolled");
}

TEST_P(Views, MirroredModel)
{
    expectOracle("mirrored_model", osg::Matrixd::translate(-12, -10, -8) *
                                       osg::Matrixd::scale(-1, 1, 1) *
                                       osg::Matrixd::translate(12, 10, 8));
    expectOracle("point_mirrored_model", osg::Matrixd::translate(-12, -10, -8) *
                                             osg::Matrixd::scale(-1, -0.8, -1.2) *
                                             osg::Matrixd::translate(12, 10, 8));
}

TEST_P(Views, MirroredView)
{
    _options.view = _options.view * osg::Matrixd::scale(-1, 1, 1);
    expectOracle("mirrored_view");
}

TEST_P(Views, MirroredProjection)
{
    _options.projection = _options.projection * osg::Matrixd::scale(1, -1, 1);
    expectOracle("mirrored_projection");
    _options.orthographic(20.0);
    _options.projection = _options.projection * osg::Matrixd::scale(-1, 1, 1);
    expectOracle("mirrored_orthographic");
}

TEST_P(Views, FromInside)
{
    _options.perspective(60.0).lookAt({12.2, 9.7, 8.1}, {20, 16, 11}, {0, 0, 1});
    expectOracle("inside");
    _options.perspective(60.0).lookAt({3, 3, 3}, {20, 18, 9}, {0, 0, 1});
    expectOracle("inside_corner");
}

TEST_P(Views, PartlyBehindTheEye)
{
    // Beside a face, looking along it, and from outside past an edge.
    _options.perspective(70.0).lookAt({12, -2, 8}, {13, 20, 8}, {0, 0, 1});
    expectOracle("close");
    _options.perspective(80.0).lookAt({12, 10, 17.5}, {26, 12, 6}, {0, 0, 1});
    expectOracle("skimming");
}

TEST_P(Views, BeforeTheNearPlaneNothingIsDrawn)
{
    _options.computeNearFar = false;
    _options.projection.makePerspective(45.0, 80.0 / 72.0, 38.0, 1000.0);
    expectOracle("near_plane", osg::Matrixd(), 38.0);
    _options.projection.makeOrtho(-20.0, 20.0, -18.0, 18.0, 40.0, 1000.0);
    expectOracle("near_plane_orthographic", osg::Matrixd(), 40.0);
}

TEST_P(Views, FovOfHalfADegree)
{
    // A telescope: the rays are nearly parallel, and the eye is far away.
    _options.perspective(0.5).lookAt({3000, -2000, 2500}, {12, 10, 8}, {0, 0, 1});
    expectOracle("telescope");
}

INSTANTIATE_TEST_SUITE_P(Techniques, Views,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

} // namespace

} // namespace ViewsTest
