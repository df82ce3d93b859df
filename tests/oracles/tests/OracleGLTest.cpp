#include <support/GLTest.h>
#include <support/OracleView.h>
#include <support/Shapes.h>

#include <osg/BlendFunc>

namespace OracleGLTest {

using namespace osgVolumizer;
using namespace osgVolumizer::support;

namespace {

class OracleGLTest : public GLTest
{
};

// Adds the same quad to a scene of OSG and to one of the oracle.
void addQuad(osg::Group& group, oracle::Scene& scene, const std::array<osg::Vec3, 4>& corners,
             const osg::Vec4& color, bool translucent)
{
    osg::ref_ptr<osg::Geometry> quad = makeQuad(corners, color, translucent);
    // Colours blend as usual; alpha adds up to coverage.
    if (translucent)
        quad->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc(
            GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA));
    group.addChild(quad);
    std::array<glm::dvec3, 4> points;
    for (int i = 0; i < 4; ++i)
        points[i] = glm::dvec3(corners[i].x(), corners[i].y(), corners[i].z());
    scene.addQuad(points, {color.r(), color.g(), color.b(), color.a()}, !translucent);
}

} // namespace

TEST_F(OracleGLTest, TrianglesLieWhereGLPutsThem)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    oracle::Scene scene;
    using Corners = std::array<osg::Vec3, 4>;
    addQuad(*group, scene, Corners{osg::Vec3(-1, 0, -1), {1, 0.5, -1}, {1, 0.5, 1}, {-1, 0, 1}},
            osg::Vec4(0.2f, 0.4f, 0.6f, 1), false);
    addQuad(*group, scene,
            Corners{osg::Vec3(-0.5, -1, -1), {1.5, -1.2, 0}, {1, -1, 1}, {-1, -0.8, 0.5}},
            osg::Vec4(1, 0.5f, 0, 0.3f), true);
    addQuad(*group, scene,
            Corners{osg::Vec3(-2, 2, -0.5), {0.3f, 2, -0.5}, {0.3f, 2, 0.7f}, {-2, 2, 0.7f}},
            osg::Vec4(0, 1, 0.5f, 0.7f), true);
    RenderOptions options = RenderOptions().size(97, 64).lookAt(
        osg::Vec3d(1, -6, 2), osg::Vec3d(0, 0, 0.1), osg::Vec3d(0.1, 0, 1));
    options.background = osg::Vec4(0.05f, 0.1f, 0.15f, 1.0f);
    scene.background = {0.05f, 0.1f, 0.15f, 1.0};
    osg::Matrixd offAxis;
    offAxis.makeFrustum(-0.3, 0.5, -0.35, 0.2, 1.0, 100.0);
    osg::Matrixd orthographic;
    orthographic.makeOrtho(-2.5, 2, -1.5, 1.75, 1.0, 100.0);
    for (const osg::Matrixd& projection : {options.projection, offAxis, orthographic}) {
        options.projection = projection;
        const FloatImage image = renderScene(group, options);
        const oracle::Camera camera = oracleCamera(options);
        const FloatImage expected = oracle::render(scene, camera);
        const Mask away = coveredPixels(oracle::awayFromSilhouettes(scene, camera));
        EXPECT_GT(away.count(), 4000u);
        const Difference d = compare(image, expected, away);
        EXPECT_LT(d.maximum, 1e-6) << d.worstX << " " << d.worstY;
    }
}

} // namespace OracleGLTest
