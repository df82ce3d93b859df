// A volume looks the same wherever its scene is, however large, and whatever OSG's Optimizer did to
// it.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Shapes.h>

#include <osg/MatrixTransform>
#include <osgUtil/Optimizer>

namespace PlacementTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr double EARTH_RADIUS = 6.4e6;
const osg::Vec3d FAR_AWAY(0.61 * EARTH_RADIUS, -0.7 * EARTH_RADIUS, 0.37 * EARTH_RADIUS);

// A view of the box of 24 x 20 x 16 voxels at the origin, moved and scaled like the scene.
RenderOptions view(bool perspective, double scale = 1.0, const osg::Vec3d& moved = osg::Vec3d())
{
    RenderOptions options;
    options.size(80, 80);
    if (perspective)
        options.perspective(45.0);
    else
        options.orthographic(20.0);
    options.lookAt(osg::Vec3d(45, -22, 30), osg::Vec3d(12, 10, 8), osg::Vec3d(0, 0, 1));
    // World to eye: undo the placement first; lengths in the eye frame scale with the scene.
    options.view = osg::Matrixd::translate(-moved) *
                   osg::Matrixd::scale(osg::Vec3d(1, 1, 1) / scale) * options.view *
                   osg::Matrixd::scale(osg::Vec3d(1, 1, 1) * scale);
    if (!perspective) options.orthographic(20.0 * scale);
    return options;
}

class Placement : public support::GLTest,
                  public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _voxels = makeVoxels({25, 21, 17}, bumps);
        ASSERT_TRUE(_voxels->setBrickSize({13, 13, 13}));
        _twin = makeTwin(_voxels, smoothPoints(0.15), GetParam());
    }

    // The volume below a transform.
    osg::ref_ptr<osg::MatrixTransform> placed(const osg::Matrixd& matrix) const
    {
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
        transform->addChild(_twin.node);
        return transform;
    }

    // Expects the picture of the volume where it was made.
    void expectSame(osg::Node* scene, double scale, const osg::Vec3d& moved,
                    const std::string& name)
    {
        const osg::ref_ptr<osg::Node> original =
            makeTwin(makeOriginal(), smoothPoints(0.15), GetParam()).node;
        for (const bool perspective : {true, false}) {
            const FloatImage expected = support::renderScene(original, view(perspective));
            const FloatImage image = support::renderScene(scene, view(perspective, scale, moved));
            support::savePicture(image, "placement_" + name + std::to_string(GetParam()) +
                                            (perspective ? "_perspective" : "_orthographic"));
            EXPECT_GT(support::coveredPixels(expected, 0.5f).count(), 1000u);
            const support::Difference d = compare(image, expected);
            EXPECT_LT(d.maximum, 1e-4)
                << name << (perspective ? ", perspective" : ", orthographic") << " at " << d.worstX
                << " " << d.worstY << ", rmse " << d.rmse;
        }
    }

    osg::ref_ptr<Voxels> makeOriginal() const
    {
        osg::ref_ptr<Voxels> voxels = makeVoxels({25, 21, 17}, bumps);
        voxels->setBrickSize({13, 13, 13});
        return voxels;
    }

    osg::ref_ptr<Voxels> _voxels;
    TwinVolume _twin;
};

TEST_P(Placement, FarAwayByTransform)
{
    expectSame(placed(osg::Matrixd::translate(FAR_AWAY)), 1.0, FAR_AWAY, "transform");
}

TEST_P(Placement, FarAwayByOrigin)
{
    ASSERT_TRUE(_voxels->setOrigin(FAR_AWAY));
    TwinVolume twin = makeTwin(_voxels, smoothPoints(0.15), GetParam());
    expectSame(twin.node, 1.0, FAR_AWAY, "origin");
}

TEST_P(Placement, ScaledByTransform)
{
    for (const double scale : {1e-6, 1e6})
        expectSame(placed(osg::Matrixd::scale(scale, scale, scale)), scale, osg::Vec3d(),
                   scale < 1.0 ? "tiny" : "huge");
}

TEST_P(Placement, ScaledBySpacing)
{
    for (const double scale : {1e-6, 1e6}) {
        ASSERT_TRUE(_voxels->setSpacing(osg::Vec3d(scale, scale, scale)));
        TwinVolume twin = makeTwin(_voxels, smoothPoints(0.15), GetParam());
        expectSame(twin.node, scale, osg::Vec3d(), scale < 1.0 ? "tiny_voxels" : "huge_voxels");
    }
}

TEST_P(Placement, AnisotropicSpacingAndTransforms)
{
    // A transform above the volume moves it, but changes no opacity; not even one that shears.
    ASSERT_TRUE(_voxels->setSpacing(osg::Vec3d(1.2, 0.6, 1.7)));
    ASSERT_TRUE(_voxels->setOrigin(osg::Vec3d(-3, 8, 2)));
    TwinVolume twin = makeTwin(_voxels, smoothPoints(0.06), GetParam());
    twin.setPeriod(0.25);
    const osg::Matrixd shear(1.0, 0.2, 0.0, 0.0,  //
                             -0.3, 1.4, 0.1, 0.0, //
                             0.0, 0.25, 0.6, 0.0, //
                             2.0, -4.0, 1.0, 1.0);
    for (const osg::Matrixd& matrix :
         {osg::Matrixd::identity(), osg::Matrixd::scale(0.5, 1.5, 0.8), shear}) {
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
        transform->addChild(twin.node);
        oracle::Scene scene = oracleScene(twin.oracle);
        scene.volumes[0].objectToWorld = support::toGlm(matrix);
        const RenderOptions options = view(true);
        const FloatImage image = support::renderScene(transform, options);
        const FloatImage expected = oraclePicture(scene, options);
        support::savePicture(image, "placement_affine");
        support::savePicture(expected, "placement_affine_oracle");
        const support::Difference d = compare(image, expected);
        EXPECT_GT(d.pixels, 500u);
        EXPECT_LT(d.rmse, 2e-3);
    }
}

TEST_P(Placement, TheOptimizerMovesNothing)
{
    const auto makeScene = [&] {
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(
            osg::Matrixd::scale(0.7, 0.8, 0.9) * osg::Matrixd::rotate(0.4, osg::Vec3d(1, 2, 3)) *
            osg::Matrixd::translate(3.0, 1.0, 2.0));
        transform->setDataVariance(osg::Object::STATIC);
        transform->addChild(makeTwin(makeOriginal(), smoothPoints(0.15), GetParam()).node);
        transform->addChild(support::makeQuad({osg::Vec3(-5, 10, -5), osg::Vec3(30, 10, -5),
                                               osg::Vec3(30, 10, 30), osg::Vec3(-5, 10, 30)},
                                              osg::Vec4(0.2f, 0.7f, 0.3f, 1.0f)));
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(transform);
        return scene;
    };
    const FloatImage expected = support::renderScene(makeScene(), view(true));
    support::savePicture(expected, "placement_optimizer" + std::to_string(GetParam()));
    EXPECT_GT(support::coveredPixels(expected, 0.1f).count(), 2000u);
    for (const unsigned options :
         {unsigned(osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS),
          unsigned(osgUtil::Optimizer::FLATTEN_STATIC_TRANSFORMS),
          // This one loses the transform of every drawable but osg::Geometry, in OSG 3.6.5.
          unsigned(osgUtil::Optimizer::ALL_OPTIMIZATIONS &
                   ~osgUtil::Optimizer::FLATTEN_STATIC_TRANSFORMS_DUPLICATING_SHARED_SUBGRAPHS)}) {
        const osg::ref_ptr<osg::Group> scene = makeScene();
        osgUtil::Optimizer().optimize(scene, options);
        const FloatImage image = support::renderScene(scene, view(true));
        support::savePicture(image, "placement_optimized" + std::to_string(options));
        const support::Difference d = compare(image, expected);
        EXPECT_LT(d.maximum, 1e-4) << "options " << options;
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, Placement,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

} // namespace

} // namespace PlacementTest
