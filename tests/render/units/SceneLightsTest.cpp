#include <osgVolumizer/render/draw/SceneLights.h>

#include <osg/Light>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <cmath>

namespace SceneLightsTest {

using namespace osgVolumizer::render;

namespace {

osg::ref_ptr<osg::Light> makeLight(unsigned number, const osg::Vec4& position)
{
    osg::ref_ptr<osg::Light> light = new osg::Light(number);
    light->setPosition(position);
    light->setDiffuse({0.5f, 0.25f, 0.125f, 1.0f});
    return light;
}

void add(osgUtil::RenderStage& stage, const osg::Light* light, const osg::Matrixd& toEye)
{
    stage.addPositionedAttribute(new osg::RefMatrix(toEye), light);
}

void expectNear(const glm::vec4& a, const glm::vec4& b)
{
    EXPECT_NEAR(glm::length(a - b), 0.0f, 1e-5f) << a.x << " " << a.y << " " << a.z << " " << a.w;
}

} // namespace

TEST(SceneLights, AreMovedToTheEyeFrame)
{
    osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    const osg::Matrixd toEye =
        osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(10, 20, 30);
    add(*stage, makeLight(3, {2, 0, 0, 2}), toEye); // at (1, 0, 0)
    add(*stage, makeLight(1, {1, 0, 0, 0}), toEye); // from +x
    const std::vector<EyeLight> lights = lightsOf(*stage);
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_EQ(lights[0].number, 3u);
    expectNear(lights[0].position, {10, 21, 30, 1});
    EXPECT_EQ(lights[1].number, 1u);
    expectNear(lights[1].position, {0, 1, 0, 0});
    EXPECT_EQ(lights[0].diffuse, glm::vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(lights[0].spot.w, -1.0f); // none
}

TEST(SceneLights, SpotsHaveUnitDirectionsAndACosine)
{
    osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    const osg::ref_ptr<osg::Light> spot = makeLight(0, {0, 0, 0, 1});
    spot->setDirection({0, 0, -1});
    spot->setSpotCutoff(60.0f);
    spot->setSpotExponent(7.0f);
    spot->setLinearAttenuation(0.5f);
    add(*stage, spot,
        osg::Matrixd::scale(5, 5, 5) * osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0)));
    const std::vector<EyeLight> lights = lightsOf(*stage);
    ASSERT_EQ(lights.size(), 1u);
    expectNear(lights[0].spot, {0, 1, 0, 0.5f});
    EXPECT_EQ(lights[0].spotExponent, 7.0f);
    EXPECT_EQ(lights[0].attenuation, glm::vec3(1.0f, 0.5f, 0.0f));
    // What comes from infinitely far has no cone.
    spot->setPosition({0, 0, 1, 0});
    EXPECT_EQ(lightsOf(*stage)[0].spot.w, -1.0f);
}

TEST(SceneLights, TheLastOfANumberCountsAndInheritedOnesComeFirst)
{
    osg::ref_ptr<osgUtil::RenderStage> outer = new osgUtil::RenderStage,
                                       inner = new osgUtil::RenderStage;
    add(*outer, makeLight(0, {1, 0, 0, 1}), osg::Matrixd());
    add(*outer, makeLight(2, {2, 0, 0, 1}), osg::Matrixd());
    add(*inner, makeLight(2, {3, 0, 0, 1}), osg::Matrixd());
    inner->setInheritedPositionalStateContainer(outer->getPositionalStateContainer());
    inner->setInheritedPositionalStateContainerMatrix(osg::Matrixd::translate(0, 5, 0));
    const std::vector<EyeLight> lights = lightsOf(*inner);
    ASSERT_EQ(lights.size(), 2u);
    expectNear(lights[0].position, {1, 5, 0, 1}); // as seen from the inner stage
    EXPECT_EQ(lights[1].number, 2u);
    expectNear(lights[1].position, {3, 0, 0, 1});
}

TEST(SceneLights, OnlyThoseSwitchedOnElseAHeadLight)
{
    std::vector<EyeLight> lights(12);
    for (unsigned i = 0; i < lights.size(); ++i)
        lights[i].number = i;
    const osg::ref_ptr<osg::State> state = new osg::State;
    const std::vector<EyeLight> head = enabledLights(lights, *state);
    ASSERT_EQ(head.size(), 1u);
    expectNear(head[0].position, {0, 0, 1, 0});
    EXPECT_EQ(head[0].diffuse, glm::vec3(1.0f));

    state->haveAppliedMode(GL_LIGHT0 + 5, osg::StateAttribute::ON);
    state->haveAppliedMode(GL_LIGHT0 + 7, osg::StateAttribute::ON);
    const std::vector<EyeLight> two = enabledLights(lights, *state);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].number, 5u);
    EXPECT_EQ(two[1].number, 7u);

    for (unsigned i = 0; i < lights.size(); ++i)
        state->haveAppliedMode(GL_LIGHT0 + i, osg::StateAttribute::ON);
    EXPECT_EQ(enabledLights(lights, *state).size(), MAXIMUM_LIGHTS);
}

} // namespace SceneLightsTest
