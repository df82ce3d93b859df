// Opaque geometry in and around volumes, against the oracle.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Precision.h>
#include <support/Shapes.h>

namespace OpaqueTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

RenderOptions view(bool perspective)
{
    RenderOptions options;
    options.size(96, 96).lookAt({40, -26, 34}, {12, 12, 12}, {0, 0, 1});
    if (perspective)
        options.perspective(50.0);
    else
        options.orthographic(22.0);
    return options;
}

class Opaque : public support::GLTest,
               public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        osg::ref_ptr<Voxels> voxels = makeVoxels({25, 25, 25}, bumps);
        ASSERT_TRUE(voxels->setBrickSize({13, 13, 13}));
        _twin = makeTwin(voxels, smoothPoints(0.05), GetParam());
        support::filterExactly(*_twin.node); // errors are those of sampling, down to 5e-6
        _group = new osg::Group;
        _scene = oracleScene(_twin.oracle);
    }

    void addQuad(const std::array<osg::Vec3, 4>& corners, const osg::Vec4& color)
    {
        _group->addChild(support::makeQuad(corners, color));
        std::array<glm::dvec3, 4> points;
        for (std::size_t i = 0; i < 4; ++i)
            points[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
        _scene.addQuad(points, {color.r(), color.g(), color.b(), color.a()}, true);
    }

    // The volume last, so that nothing depends on the order of nodes.
    void expectOracle(const std::string& name)
    {
        _group->addChild(_twin.node);
        const bool slabs = GetParam() == VolumeAppearance::SLABS;
        for (const bool perspective : {true, false}) {
            const RenderOptions options = view(perspective);
            const FloatImage expected = oraclePicture(_scene, options);
            const support::Mask away = awayFromSilhouettes(_scene, options);
            EXPECT_GT(away.count(), 4000u);
            std::vector<double> steps, errors;
            FloatImage image;
            for (double period = slabs ? 2.0 : 1.0; period > 0.2; period *= 0.5) {
                _twin.setPeriod(period);
                image = support::renderScene(_group, options);
                const FloatImage apart =
                    support::renderScene(_group, support::joining(options, false));
                steps.push_back(period);
                errors.push_back(std::max(compare(image, expected, away).rmse,
                                          compare(apart, expected, away).rmse));
            }
            support::savePicture(image, "opaque_" + name + std::to_string(GetParam()));
            EXPECT_LE(errors.back(), slabs ? 2e-5 : 2e-3);
            EXPECT_GE(support::convergenceOrder(steps, errors), slabs ? 1.9 : 0.9)
                << name << (perspective ? ", perspective: " : ", orthographic: ") << errors.front()
                << " to " << errors.back();
        }
    }

    TwinVolume _twin;
    osg::ref_ptr<osg::Group> _group;
    oracle::Scene _scene;
};

TEST_P(Opaque, InFront)
{
    addQuad({osg::Vec3(20, -12, 8), {30, -8, 8}, {30, -8, 24}, {20, -12, 24}},
            {0.2f, 0.8f, 0.3f, 1});
    expectOracle("front");
}

TEST_P(Opaque, Behind)
{
    addQuad({osg::Vec3(-8, 40, -20), {-30, 10, -20}, {-30, 10, 30}, {-8, 40, 30}},
            {0.2f, 0.8f, 0.3f, 1});
    expectOracle("behind");
}

TEST_P(Opaque, Inside)
{
    addQuad({osg::Vec3(6, 12, 5), {18, 11, 5}, {18, 11, 20}, {6, 12, 20}}, {0.2f, 0.8f, 0.3f, 1});
    addQuad({osg::Vec3(4, 4, 4), {20, 4, 4}, {20, 20, 4}, {4, 20, 4}}, {0.9f, 0.9f, 0.9f, 1});
    expectOracle("inside");
}

TEST_P(Opaque, SlantedThrough)
{
    addQuad({osg::Vec3(-10, 2, -6), {34, 6, 4}, {36, 34, 30}, {-8, 20, 26}}, {0.2f, 0.8f, 0.3f, 1});
    addQuad({osg::Vec3(30, -10, 10), {34, 34, 14}, {14, 30, 12}, {8, -8, 6}},
            {0.7f, 0.1f, 0.1f, 1});
    expectOracle("slanted");
}

INSTANTIATE_TEST_SUITE_P(Techniques, Opaque,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

} // namespace

} // namespace OpaqueTest
