// An error that is asked for is kept by lit volumes, too.

#include "TestLights.h"

#include <support/Choices.h>
#include <support/GLTest.h>
#include <support/Instrumented.h>

#include <osg/MatrixTransform>

#include <cmath>
#include <random>

namespace LitToleranceTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 24;

double noise(const glm::dvec3& p)
{
    const auto i = static_cast<unsigned>(p.x + SIZE * (p.y + SIZE * p.z));
    return double(std::mt19937(i)()) / 4294967296.0;
}

// As rough as what scanners make of something smooth.
double roughBumps(const glm::dvec3& p)
{
    return 0.9 * bumps(p) + 0.1 * noise(p);
}

struct Case
{
    const char* name;
    double (*field)(const glm::dvec3&);
    Points points;
};

std::vector<Case> cases()
{
    const Points jumps{{0.0, {0.2, 0.4, 0.9, 0.0}},
                       {0.5, {0.2, 0.4, 0.9, 0.0}},
                       {0.5, {1.0, 0.6, 0.1, 0.2}},
                       {1.0, {0.9, 0.2, 0.1, 0.6}}};
    return {{"smooth", bumps, smoothPoints(0.2)},
            {"jumps", bumps, jumps},
            {"rough", roughBumps, smoothPoints(0.2)},
            {"rough jumps", roughBumps, jumps},
            {"noise", noise, smoothPoints(0.1)}};
}

RenderOptions view(const osg::Vec3d& eye, bool perspective)
{
    RenderOptions options = RenderOptions().size(48, 48).lookAt(eye, {11, 11, 11}, {0, 0, 1});
    return perspective ? options.perspective(30.0) : options.orthographic(18.0);
}

std::vector<RenderOptions> views()
{
    return {view({50, -30, 35}, true), view({-28, 40, 37}, true), view({11.3, -50, 10.8}, false)};
}

// White, from far away.
TestLight lamp(const glm::dvec3& direction)
{
    TestLight light;
    light.position = glm::dvec4(direction, 0.0);
    return light;
}

TestLight headLight(const RenderOptions& options)
{
    TestLight light;
    light.position = glm::inverse(support::toGlm(options.view)) * glm::dvec4(0, 0, 1, 0);
    return light;
}

// A scene, and what there is to see of it in several views.
class Examiner
{
public:
    /// Without any lights volumes have a head light.
    Examiner(const Case& c, const std::vector<TestLight>& lights)
        : _voxels(makeVoxels(glm::ivec3(SIZE), c.field)), _twin(makeTwin(_voxels, c.points)),
          _scene(new osg::Group)
    {
        _twin.node->setShading(true);
        _scene->addChild(_twin.node);
        for (std::size_t i = 0; i < lights.size(); ++i)
            _scene->addChild(makeSource(lights[i], int(i), *_scene->getOrCreateStateSet()));
        for (const RenderOptions& options : views()) {
            oracle::Volume volume = _twin.oracle;
            const std::vector<TestLight> head = {headLight(options)};
            lightOracle(volume, gridOf(*_voxels), lights.empty() ? head : lights, options,
                        _twin.node->getMaterial());
            oracle::Scene scene = oracleScene(volume);
            scene.tolerance = 1e-6;
            _expected.push_back(oraclePicture(scene, options));
        }
    }

    VolumeAppearance& node() { return *_twin.node; }
    VolumeAppearance::Settings settings() const
    {
        const auto& geometry = dynamic_cast<const VolumeGeometry&>(*_twin.node->getChild(0));
        return _twin.node->getSettingsInForce(geometry);
    }

    double worstError()
    {
        double worst = 0.0;
        for (std::size_t i = 0; i < _expected.size(); ++i) {
            const support::Mask covered = support::coveredPixels(_expected[i], 1e-3f);
            const FloatImage image = support::renderScene(_scene, views()[i]);
            worst = std::max(worst, support::compare(image, _expected[i], covered).rmse);
        }
        return worst;
    }

private:
    osg::ref_ptr<Voxels> _voxels;
    TwinVolume _twin;
    osg::ref_ptr<osg::Group> _scene;
    std::vector<FloatImage> _expected;
};

using LitTolerance = support::GLTest;

TEST_F(LitTolerance, IsKept)
{
    for (const Case& c : cases())
        for (const bool fromEye : {true, false}) {
            if (fromEye && c.field == noise) continue; // the slowest, and much like the other one
            if (support::INSTRUMENTED && (fromEye || c.field != roughBumps)) continue;
            Examiner examiner(c, fromEye ? std::vector<TestLight>()
                                         : std::vector<TestLight>{lamp({-0.5, -0.7, 0.6})});
            for (const double tolerance : {1e-2, 1e-3}) {
                if (support::INSTRUMENTED && tolerance < 1e-2) continue;
                ASSERT_TRUE(examiner.node().setErrorTolerance(tolerance));
                EXPECT_LE(examiner.worstError(), tolerance) << c.name << ", before the choice";
                ASSERT_TRUE(support::waitForChoice(examiner.node()));
                EXPECT_LE(examiner.worstError(), tolerance) << c.name << ", " << tolerance;
                EXPECT_LE(examiner.settings().expectedError, tolerance)
                    << c.name << ", " << tolerance;
            }
        }
}

// Three times as bright, errors are three times as large; once a frame has shown that, the choice
// is another one.
TEST_F(LitTolerance, KnowsHowBrightItIs)
{
    const Case c = cases()[2];
    Examiner examiner(c, {lamp({-0.5, -0.7, 0.6}), lamp({0.9, 0.1, 0.3}), lamp({0.1, -0.8, -0.6})});
    ASSERT_TRUE(examiner.node().setErrorTolerance(2e-3));
    ASSERT_TRUE(support::waitForChoice(examiner.node()));
    EXPECT_FALSE(examiner.settings().refining);
    (void)examiner.worstError();
    EXPECT_TRUE(examiner.settings().refining);
    ASSERT_TRUE(support::waitForChoice(examiner.node()));
    EXPECT_LE(examiner.worstError(), 2e-3);
}

} // namespace

} // namespace LitToleranceTest
