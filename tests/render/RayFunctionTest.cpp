// Maximum, minimum, average, sum and isosurface, against the exact values of the trilinear field.

#include "Volumes.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/render/draw/RayFunctions.h>
#include <osgVolumizer/render/draw/VolumeProgram.h>

#include <oracles/Projection.h>
#include <oracles/Ray.h>
#include <support/GLTest.h>
#include <support/Precision.h>
#include <support/Shapes.h>

#include <cmath>
#include <iterator>

namespace RayFunctionTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using RayFunction = support::GLTest;
using Function = VolumeAppearance::RayFunction;

constexpr int SIZE = 21;
const Points TABLE{
    {0.0, {0.1, 0.9, 0.4, 0.1}}, {0.5, {0.9, 0.2, 0.4, 0.3}}, {1.0, {0.2, 0.3, 1.0, 0.8}}};

RenderOptions view(bool perspective = true)
{
    RenderOptions options;
    options.size(90, 80);
    if (perspective)
        options.perspective(40.0);
    else
        options.orthographic(18.0);
    return options.lookAt({40, -38, 32}, {10, 10, 10}, {0, 0, 1});
}

// What the documentation promises of a pixel.
glm::dvec4 promised(const oracle::Projection& p, Function function, const oracle::Table& table)
{
    const double value = function == VolumeAppearance::MAXIMUM   ? p.maximum
                         : function == VolumeAppearance::MINIMUM ? p.minimum
                         : function == VolumeAppearance::AVERAGE ? p.integral / p.length
                                                                 : p.integral;
    const glm::dvec4 c = table.color(value);
    return {glm::dvec3(c) * c.a, c.a};
}

FloatImage expectedPicture(const oracle::Volume& volume, const RenderOptions& options,
                           Function function)
{
    const oracle::Camera camera = support::oracleCamera(options);
    FloatImage image(camera.width, camera.height);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            oracle::Projection p;
            if (project(volume, camera, x + 0.5, y + 0.5, p))
                image.at(x, y) = glm::vec4(promised(p, function, volume.table));
        }
    return image;
}

TwinVolume makeTwinOf(Function function)
{
    TwinVolume twin = makeTwin(makeVoxels(glm::ivec3(SIZE), bumps), TABLE);
    twin.node->setRayFunction(function);
    if (function == VolumeAppearance::SUM) {
        twin.node->setOpacityUnit(40.0);
        twin.oracle.unit = 40.0;
    }
    return twin;
}

TEST_F(RayFunction, ReducesTheValuesOfEveryRay)
{
    for (const Function function : {VolumeAppearance::MAXIMUM, VolumeAppearance::MINIMUM,
                                    VolumeAppearance::AVERAGE, VolumeAppearance::SUM})
        for (const bool perspective : {true, false}) {
            TwinVolume twin = makeTwinOf(function);
            support::filterExactly(*twin.node); // for the order of sampling
            const RenderOptions options = view(perspective);
            const FloatImage expected = expectedPicture(twin.oracle, options, function);
            const support::Mask inside = awayFromSilhouettes(oracleScene(twin.oracle), options);
            double errors[2];
            for (int level = 0; level < 2; ++level) {
                twin.setPeriod(level == 0 ? 1.0 : 0.25);
                const FloatImage image = support::renderScene(twin.node, options);
                errors[level] = support::compare(image, expected, inside).rmse;
            }
            EXPECT_LT(errors[1], 1e-4) << function;
            // Extremes are refined between samples, so there is less to gain.
            const bool extreme =
                function == VolumeAppearance::MAXIMUM || function == VolumeAppearance::MINIMUM;
            EXPECT_LT(errors[1], (extreme ? 0.5 : 0.12) * errors[0]);
        }
}

TEST_F(RayFunction, DoesNotDependOnBricks)
{
    for (const Function function :
         {VolumeAppearance::MAXIMUM, VolumeAppearance::MINIMUM, VolumeAppearance::AVERAGE,
          VolumeAppearance::SUM, VolumeAppearance::ISOSURFACE}) {
        const bool surface = function == VolumeAppearance::ISOSURFACE;
        TwinVolume twin = makeTwinOf(function);
        twin.setPeriod(0.25);
        const FloatImage one = support::renderScene(twin.node, view());
        osg::ref_ptr<Voxels> bricks = makeVoxels(glm::ivec3(SIZE), bumps);
        bricks->setBrickSize({9, 9, 9});
        twin.node->setVoxels(bricks);
        for (const bool joined : {true, false}) {
            const FloatImage many =
                support::renderScene(twin.node, support::joining(view(), joined));
            const double rmse = support::compare(many, one).rmse;
            EXPECT_LT(rmse, surface ? 0.1 : 1e-4) << function;
            // A surface that is grazed may be missed by one of them.
            int wrong = 0;
            for (std::size_t i = 0; i < one.pixels.size(); ++i)
                wrong += glm::length(many.pixels[i] - one.pixels[i]) > 5e-3f;
            EXPECT_LE(wrong, surface && !joined ? 10 : 0) << function;
        }
    }
}

TEST_F(RayFunction, SlicesGiveTheSameInTheLimit)
{
    for (const Function function : {VolumeAppearance::MAXIMUM, VolumeAppearance::MINIMUM,
                                    VolumeAppearance::AVERAGE, VolumeAppearance::SUM}) {
        TwinVolume twin = makeTwinOf(function);
        twin.node->setTechnique(VolumeAppearance::SLICES);
        const FloatImage expected = expectedPicture(twin.oracle, view(), function);
        // Where a ray is so short that hardly a slice is on it there is no limit yet.
        support::Mask inside = awayFromSilhouettes(oracleScene(twin.oracle), view());
        twin.setPeriod(0.1);
        EXPECT_LT(support::compare(support::renderScene(twin.node, view()), expected, inside).rmse,
                  1.5e-2)
            << function;
    }
}

TEST_F(RayFunction, EndsAtOpaqueGeometryAndIsDrawnOverIt)
{
    TwinVolume twin = makeTwinOf(VolumeAppearance::MAXIMUM);
    twin.setPeriod(0.25);
    using Corners = std::array<osg::Vec3, 4>;
    const Corners corners{osg::Vec3(-8, 12, -8), {30, 12, -8}, {30, 12, 30}, {-8, 12, 30}};
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(support::makeQuad(corners, osg::Vec4(0.2f, 0.6f, 0.4f, 1)));
    scene->addChild(twin.node);
    const FloatImage image = support::renderScene(scene, view());

    oracle::Scene quad;
    std::array<glm::dvec3, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
        points[i] = glm::dvec3(corners[i].x(), corners[i].y(), corners[i].z());
    quad.addQuad(points, {0.2f, 0.6f, 0.4f, 1}, true);
    const oracle::Camera camera = support::oracleCamera(view());
    FloatImage expected = oracle::render(quad, camera);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            oracle::Camera bounded = camera;
            oracle::Hit hit;
            for (const oracle::Triangle& t : quad.triangles)
                if (oracle::hit(rayThrough(camera, x + 0.5, y + 0.5), camera, t, hit))
                    bounded.farDepth = hit.depth;
            oracle::Projection p;
            if (!project(twin.oracle, bounded, x + 0.5, y + 0.5, p)) continue;
            const glm::dvec4 c = promised(p, VolumeAppearance::MAXIMUM, twin.oracle.table);
            expected.at(x, y) = glm::vec4(c + (1.0 - c.a) * glm::dvec4(expected.at(x, y)));
        }
    oracle::Scene all = oracleScene(twin.oracle);
    all.triangles = quad.triangles;
    const support::Mask inside = awayFromSilhouettes(all, view());
    EXPECT_LT(support::compare(image, expected, inside).rmse, 2e-4);
}

TEST_F(RayFunction, IsosurfaceIsTheFirstRootOfTheInterpolant)
{
    TwinVolume twin = makeTwinOf(VolumeAppearance::ISOSURFACE);
    twin.node->setIsoValue(0.62);
    twin.setPeriod(0.25);
    const FloatImage image = support::renderScene(twin.node, view());
    const oracle::Camera camera = support::oracleCamera(view());
    const glm::dvec4 color = twin.oracle.table.color(0.62);
    int hits = 0, wrong = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            double depth;
            const bool hit = firstCrossing(twin.oracle, camera, x + 0.5, y + 0.5, 0.62, depth);
            const glm::vec4 expected = hit ? glm::vec4(glm::vec3(color), 1.0f) : glm::vec4(0.0f);
            hits += hit;
            const glm::vec4 d = glm::abs(image.at(x, y) - expected);
            wrong += std::max({d.r, d.g, d.b, d.a}) > 1e-4f;
        }
    EXPECT_GT(hits, 1000);
    EXPECT_LE(wrong, hits / 200) << "rays that graze the surface within a step may miss it";
}

TEST_F(RayFunction, WhatRgbaVoxelsCannotDoIsSaid)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(4);
    description.type = VoxelType::UINT8;
    description.components = 4;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    auto* bytes = static_cast<unsigned char*>(source->data());
    for (int i = 0; i < 64; ++i) {
        const unsigned char texel[] = {200, 100, 50, static_cast<unsigned char>(i == 21 ? 255 : 0)};
        std::copy(texel, texel + 4, bytes + 4 * i);
    }
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(new Voxels(source));
    volume->setName("four channels");
    volume->setRayFunction(VolumeAppearance::MAXIMUM);
    RenderOptions options;
    options.size(32, 32).orthographic(2.0).lookAt({1, -9, 1}, {1, 1, 1}, {0, 0, 1});
    volume->setSamplingPeriod(osg::Vec3d(0.1, 0.1, 0.1));
    const FloatImage image = support::renderScene(volume, options);
    EXPECT_NEAR(image.at(15, 15).a, 1.0f, 0.15f);
    EXPECT_NEAR(image.at(15, 15).r / image.at(15, 15).a, 200 / 255.0f, 0.1f);
    clearLastError();
    volume->setRayFunction(VolumeAppearance::AVERAGE);
    const FloatImage averaged = support::renderScene(volume, options);
    EXPECT_NE(getLastError().text.find("four channels"), std::string::npos);
    volume->setRayFunction(VolumeAppearance::COMPOSITE);
    EXPECT_EQ(support::compare(averaged, support::renderScene(volume, options)).maximum, 0.0);
}

// Compiles programs in a context of the renderer's.
class Compiles : public osg::Drawable
{
public:
    Compiles()
    {
        setUseDisplayList(false);
        setSupportsDisplayList(false);
        setInitialBound(osg::BoundingBox(-1, -1, -1, 1, 1, 1));
    }
    void drawImplementation(osg::RenderInfo& renderInfo) const override
    {
        osg::State& state = *renderInfo.getState();
        for (const auto& program : programs) {
            program.second->apply(state);
            const auto* made = program.second->getPCP(state);
            std::string log;
            if (made) made->getInfoLog(log);
            EXPECT_TRUE(made && made->isLinked()) << program.first << ": " << log;
            compiled += made && made->isLinked();
        }
        state.get<osg::GLExtensions>()->glUseProgram(0);
        state.setLastAppliedProgramObject(nullptr);
        state.haveAppliedAttribute(osg::StateAttribute::PROGRAM);
    }
    std::vector<std::pair<std::string, osg::ref_ptr<osg::Program>>> programs;
    mutable std::size_t compiled = 0;
};

void addPrograms(Function function, Compiles& compiles)
{
    const render::RayFunctionRow& row = render::rowOf(function);
    const std::string name = VolumeAppearance::RAY_FUNCTION_NAMES[function];
    for (const bool rgba : {false, true}) {
        if (rgba && row.needsOneComponent) continue;
        for (const bool slab : {true, false}) {
            if (!slab && row.needsSlabs) continue;
            render::ProgramFeatures features;
            features.rayFunction = function;
            features.rgba = rgba;
            features.slab = features.opaqueDepth = slab;
            const osg::ref_ptr<osg::StateSet> set = render::volumeStateSet(features);
            compiles.programs.emplace_back(
                name + (slab ? " of slabs" : " of slices"),
                static_cast<osg::Program*>(set->getAttribute(osg::StateAttribute::PROGRAM)));
        }
        if (row.gathers)
            compiles.programs.emplace_back(name + " resolved",
                                           render::makeResolveProgram(function, rgba));
    }
}

TEST_F(RayFunction, EveryShaderCompiles)
{
    osg::ref_ptr<Compiles> compiles = new Compiles;
    for (std::size_t i = 0; i < std::size(VolumeAppearance::RAY_FUNCTION_NAMES); ++i)
        addPrograms(static_cast<Function>(i), *compiles);
    EXPECT_GE(compiles->programs.size(), 20u);
    const RenderOptions options =
        RenderOptions().size(8, 8).lookAt({0, -9, 0}, {0, 0, 0}, {0, 0, 1});
    support::renderScene(compiles, options);
    EXPECT_EQ(compiles->compiled, compiles->programs.size());
}

TEST(RayFunctionProperties, RefuseWhatHasNoMeaning)
{
    osg::ref_ptr<VolumeAppearance> volume = new VolumeAppearance;
    EXPECT_FALSE(volume->setIsoValue(NAN));
    EXPECT_EQ(volume->getIsoValue(), 0.5);
    EXPECT_FALSE(volume->setMaterial({0.1, -1.0, 0.0, 1.0}));
    EXPECT_FALSE(volume->setMaterial({0.1, 1.0, INFINITY, 1.0}));
    EXPECT_EQ(volume->getMaterial().diffuse, 0.8);
    EXPECT_FALSE(volume->setAccumulationBits(24));
    EXPECT_TRUE(volume->setAccumulationBits(16));
}

} // namespace

} // namespace RayFunctionTest
