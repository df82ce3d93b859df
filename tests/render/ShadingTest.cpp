// Light on volumes, against Blinn-Phong in double precision on the exact gradient rule.

#include "TestLights.h"

#include <osgVolumizer/Error.h>

#include <osg/MatrixTransform>

#include <oracles/Projection.h>
#include <oracles/Ray.h>
#include <support/GLTest.h>
#include <support/Precision.h>

#include <cmath>

namespace ShadingTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using Shading = support::GLTest;

constexpr int SIZE = 21;
const Points TABLE{{0.0, {0.1, 0.8, 0.4, 0.02}}, {1.0, {1.0, 0.3, 0.4, 0.4}}};

RenderOptions view(bool perspective = true)
{
    RenderOptions options;
    options.size(72, 64);
    if (perspective)
        options.perspective(40.0);
    else
        options.orthographic(18.0);
    return options.lookAt({40, -38, 32}, {10, 10, 10}, {0, 0, 1});
}

TEST_F(Shading, SeveralLightsInPerspectiveAndOrthographicViews)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const std::vector<TestLight> lights = someLights();
    for (const bool perspective : {true, false})
        for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
            const RenderOptions options = view(perspective);
            TwinVolume twin = makeTwin(voxels, TABLE, technique);
            twin.node->setShading(true);
            lightOracle(twin.oracle, gridOf(*voxels), lights, options, twin.node->getMaterial());
            osg::ref_ptr<osg::Group> scene = new osg::Group;
            for (std::size_t i = 0; i < lights.size(); ++i)
                scene->addChild(makeSource(lights[i], int(i) + 2, *scene->getOrCreateStateSet()));
            scene->addChild(twin.node);
            oracle::Scene expectedScene = oracleScene(twin.oracle);
            expectedScene.tolerance = 1e-7;
            const FloatImage expected = oraclePicture(expectedScene, options);
            const support::Mask inside = awayFromSilhouettes(expectedScene, options);
            twin.setPeriod(0.25);
            const FloatImage image = support::renderScene(scene, options);
            const double rmse = support::compare(image, expected, inside).rmse;
            if (technique == VolumeAppearance::SLABS)
                support::savePicture(image, perspective ? "lit" : "lit_orthographic");
            EXPECT_LT(rmse, technique == VolumeAppearance::SLABS ? 2e-4 : 5e-3);
        }
}

TEST_F(Shading, NormalsFollowAnyAffineTransform)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    voxels->setSpacing(osg::Vec3d(1.0, 0.5, 2.0));
    const std::vector<TestLight> lights = someLights();
    const RenderOptions options = view();
    TwinVolume twin = makeTwin(voxels, TABLE);
    twin.node->setShading(true);
    osg::Matrixd matrix(0.9, 0.3, 0.0, 0.0, -0.5, 1.4, 0.2, 0.0, 0.1, 0.0, -0.45, 0.0, 2.0, 1.0,
                        20.0,
                        1.0); // mirrored, sheared
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->addChild(twin.node);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (std::size_t i = 0; i < lights.size(); ++i)
        scene->addChild(makeSource(lights[i], int(i), *scene->getOrCreateStateSet()));
    scene->addChild(transform);
    twin.oracle.objectToWorld = support::toGlm(matrix);
    lightOracle(twin.oracle, gridOf(*voxels), lights, options, twin.node->getMaterial());
    oracle::Scene expectedScene = oracleScene(twin.oracle);
    expectedScene.tolerance = 1e-7;
    const FloatImage expected = oraclePicture(expectedScene, options);
    twin.setPeriod(0.25);
    const FloatImage image = support::renderScene(scene, options);
    EXPECT_LT(support::compare(image, expected, awayFromSilhouettes(expectedScene, options)).rmse,
              3e-4);
}

TEST_F(Shading, OfCubicInterpolationByItsDerivative)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const std::vector<TestLight> lights = someLights();
    const RenderOptions options = view();
    TwinVolume twin = makeTwin(voxels, TABLE);
    twin.node->setShading(true);
    twin.node->setInterpolation(VolumeAppearance::CUBIC);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (std::size_t i = 0; i < lights.size(); ++i)
        scene->addChild(makeSource(lights[i], int(i), *scene->getOrCreateStateSet()));
    scene->addChild(twin.node);
    const auto cubic = gridOf(*voxels, oracle::Grid::CUBIC);
    twin.oracle = oracle::voxelVolume(cubic, glm::ivec3(SIZE), oracle::Table(TABLE));
    twin.setPeriod(0.25);
    const FloatImage image = support::renderScene(scene, options);
    const auto error = [&](bool derivative) {
        oracle::Volume volume = twin.oracle;
        lightOracle(volume, cubic, lights, options, twin.node->getMaterial(), derivative);
        oracle::Scene expected = oracleScene(volume);
        expected.tolerance = 1e-7;
        return support::compare(image, oraclePicture(expected, options),
                                awayFromSilhouettes(expected, options))
            .rmse;
    };
    EXPECT_LT(error(true), 3e-4);
    EXPECT_GT(error(false), 2.0 * error(true)); // it is no difference of values
}

TEST_F(Shading, PrecomputedGradientsShowTheSame)
{
    // One-sided differences at the border blend a little differently.
    for (const auto type : {VoxelType::FLOAT32, VoxelType::UINT8}) {
        VoxelSource::Description description;
        description.size = glm::ivec3(SIZE);
        description.type = type;
        std::vector<double> values;
        for (int z = 0; z < SIZE; ++z)
            for (int y = 0; y < SIZE; ++y)
                for (int x = 0; x < SIZE; ++x)
                    values.push_back(bumps(glm::dvec3(x, y, z)) *
                                     (type == VoxelType::UINT8 ? 255 : 1));
        const auto bytes = oracle::fromDoubles(values, type);
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        source->allocate(description);
        std::copy(bytes.begin(), bytes.end(), static_cast<unsigned char*>(source->data()));
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        TwinVolume twin;
        twin.node = makeVolume(voxels);
        twin.node->setLookupTable(makeTable(TABLE));
        twin.node->setShading(true);
        twin.setPeriod(0.5);
        const FloatImage onTheFly = support::renderScene(twin.node, view());
        twin.node->setGradients(VolumeAppearance::PRECOMPUTED);
        support::SceneRenderer renderer(twin.node, view());
        const FloatImage precomputed = renderer.render();
        EXPECT_LT(support::compare(onTheFly, precomputed).rmse, 1e-2);
        EXPECT_GT(support::compare(onTheFly, precomputed).pixels, 1000u);
        const double texel = type == VoxelType::UINT8 ? 8.0 : 16.0;
        EXPECT_EQ(renderer.counters().at("osgVolumizer bytes uploaded"),
                  texel * SIZE * SIZE * SIZE);
    }
}

TEST_F(Shading, BricksWithEnoughOverlapShowNoSeams)
{
    TwinVolume twin = makeTwin(makeVoxels(glm::ivec3(SIZE), bumps), TABLE);
    twin.node->setShading(true);
    twin.setPeriod(0.25);
    for (const auto gradients : {VolumeAppearance::ON_THE_FLY, VolumeAppearance::PRECOMPUTED}) {
        twin.node->setGradients(gradients);
        osg::ref_ptr<Voxels> whole = makeVoxels(glm::ivec3(SIZE), bumps);
        twin.node->setVoxels(whole);
        const FloatImage one = support::renderScene(twin.node, view());
        osg::ref_ptr<Voxels> bricks = makeVoxels(glm::ivec3(SIZE), bumps);
        bricks->setBrickSize({12, 12, 12});
        bricks->setOverlap(twin.node->getRequiredOverlap());
        twin.node->setVoxels(bricks);
        for (const bool joined : {true, false}) {
            const FloatImage many =
                support::renderScene(twin.node, support::joining(view(), joined));
            EXPECT_LT(support::compare(many, one).rmse, 1e-4);
        }
    }
}

TEST_F(Shading, TheHeadLightIsOsgsOrOurs)
{
    // Without any light: one along the view. OSG's head light is the same one, less bright.
    TwinVolume twin = makeTwin(makeVoxels(glm::ivec3(SIZE), bumps), TABLE);
    twin.node->setShading(true);
    twin.node->setMaterial({0.1, 0.9, 0.0, 1.0});
    twin.setPeriod(0.5);
    RenderOptions options = view();
    TestLight head;
    head.position = glm::inverse(support::toGlm(options.view)) * glm::dvec4(0, 0, 1, 0);
    for (const bool osgLight : {false, true}) {
        options.light = osgLight;
        head.color = glm::dvec3(osgLight ? 0.8 : 1.0); // osg::View's default light
        head.ambient = glm::dvec3(0.0);
        oracle::Volume volume = twin.oracle;
        lightOracle(volume, gridOf(*twin.node->getVoxels()), {head}, options,
                    twin.node->getMaterial());
        oracle::Scene expectedScene = oracleScene(volume);
        expectedScene.tolerance = 1e-7;
        const FloatImage image = support::renderScene(twin.node, options);
        const FloatImage expected = oraclePicture(expectedScene, options);
        EXPECT_LT(
            support::compare(image, expected, awayFromSilhouettes(expectedScene, options)).rmse,
            5e-4)
            << osgLight;
    }
}

TEST_F(Shading, ALightThatIsOffDoesNothing)
{
    TwinVolume twin = makeTwin(makeVoxels(glm::ivec3(SIZE), bumps), TABLE);
    twin.node->setShading(true);
    const std::vector<TestLight> lights = someLights();
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<osg::StateSet> unused = new osg::StateSet;
    scene->addChild(makeSource(lights[0], 1, *scene->getOrCreateStateSet()));
    scene->addChild(twin.node);
    const FloatImage one = support::renderScene(scene, view());
    scene->addChild(makeSource(lights[1], 3, *unused));
    EXPECT_EQ(support::compare(support::renderScene(scene, view()), one).maximum, 0.0);
    scene->addChild(makeSource(lights[2], 4, *scene->getOrCreateStateSet()));
    EXPECT_GT(support::compare(support::renderScene(scene, view()), one).rmse, 1e-2);
}

TEST_F(Shading, IsosurfacesAreLitAtTheirRoots)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    TwinVolume twin = makeTwin(voxels, TABLE);
    twin.node->setRayFunction(VolumeAppearance::ISOSURFACE);
    // What is tested is where the normal is taken, and how. Values off by e move the root by e over
    // the slope along the ray, and turn the normal by e over the slope: some hundredths for weights
    // of 8 bits, which highlights multiply.
    support::filterExactly(*twin.node);
    twin.node->setIsoValue(0.62);
    twin.node->setShading(true);
    twin.setPeriod(0.25);
    const RenderOptions options = view();
    const std::vector<TestLight> lights = someLights();
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (std::size_t i = 0; i < lights.size(); ++i)
        scene->addChild(makeSource(lights[i], int(i), *scene->getOrCreateStateSet()));
    scene->addChild(twin.node);
    const FloatImage image = support::renderScene(scene, options);
    support::savePicture(image, "isosurface");
    const auto grid = gridOf(*voxels);
    lightOracle(twin.oracle, grid, lights, options, twin.node->getMaterial());
    const oracle::Camera camera = support::oracleCamera(options);
    int hits = 0, wrong = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            double depth;
            if (!firstCrossing(twin.oracle, camera, x + 0.5, y + 0.5, 0.62, depth)) continue;
            oracle::Crossing c;
            cross(rayThrough(camera, x + 0.5, y + 0.5), camera, twin.oracle, c);
            const glm::dvec3 expected = twin.oracle.shade(glm::dvec3(twin.oracle.table.color(0.62)),
                                                          c.fieldOrigin + depth * c.fieldDirection,
                                                          c.eyeOrigin + depth * c.eyeDirection);
            ++hits;
            wrong += glm::length(glm::dvec3(image.at(x, y)) - expected) > 1e-3;
        }
    EXPECT_GT(hits, 500);
    EXPECT_LE(wrong, hits / 100);
}

} // namespace

} // namespace ShadingTest
