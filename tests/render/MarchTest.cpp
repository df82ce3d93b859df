// By fragments or by a compute shader: the same picture.

#include "MixedScene.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/render/context/March.h>

#include <support/GLTest.h>
#include <support/Hooks.h>

#include <optional>

namespace MarchTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using render::MarchTimes;
using support::FloatImage;
using support::RenderOptions;
using Kind = render::March;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 24; // voxels per axis
const Points WARM = {{0.0, {0.1, 0.3, 0.9, 0.02}}, {1.0, {1.0, 0.4, 0.1, 0.2}}};
const Points COLD = {{0.0, {0.1, 0.9, 0.3, 0.01}}, {1.0, {0.2, 0.2, 1.0, 0.25}}};
constexpr char COUNTER[] = "osgVolumizer compute marches";

struct Drawn
{
    FloatImage picture;
    double computed = 0.0; // marches by compute shaders
};

class March : public support::GLTest
{
protected:
    March()
    {
        _options.size(90, 70).perspective(40.0).lookAt({50, -36, 44}, {12, 12, 12}, {0, 0, 1});
    }
    ~March() override { render::setMarch(_asked); }
    void SetUp() override
    {
        GLTest::SetUp();
        clearLastError();
    }

    static Drawn draw(const MixedScene& scene, const RenderOptions& options,
                      std::optional<Kind> march)
    {
        render::setMarch(march);
        support::SceneRenderer renderer(scene.root(), options);
        Drawn drawn;
        drawn.picture = renderer.render();
        drawn.computed = renderer.counters()[COUNTER];
        return drawn;
    }
    // Expects the same picture of both.
    void compare(const MixedScene& scene, const RenderOptions& options, double marches = 1.0,
                 double allowed = 1e-6) const
    {
        const Drawn fragments = draw(scene, options, Kind::FRAGMENTS);
        const Drawn compute = draw(scene, options, Kind::COMPUTE);
        const support::Difference d = support::compare(compute.picture, fragments.picture);
        EXPECT_EQ(fragments.computed, 0.0);
        EXPECT_EQ(compute.computed, marches);
        EXPECT_GT(d.pixels, 500u);
        EXPECT_LE(d.maximum, allowed);
        EXPECT_EQ(getLastError().text, "");
    }
    // Expects a message, and what fragments draw, in a context that a hook spoils.
    void expectFragments(const std::function<void(render::ContextHooks&)>& spoil,
                         std::optional<Kind> march, const std::string& message) const
    {
        const Drawn expected = draw(several(2), _options, Kind::FRAGMENTS);
        const RenderOptions spoilt = support::prepared(
            _options, [spoil](osgViewer::Viewer& viewer) { spoil(support::contextHooks(viewer)); });
        const Drawn drawn = draw(several(2), spoilt, march);
        EXPECT_EQ(drawn.computed, 0.0);
        EXPECT_LE(support::compare(drawn.picture, expected.picture).maximum, 0.0);
        EXPECT_NE(getLastError().text.find(message), std::string::npos) << getLastError().text;
    }
    static osg::ref_ptr<Voxels> voxels() { return makeVoxels(glm::ivec3(SIZE), bumps); }
    static osg::Matrixd turned(double angle)
    {
        const osg::Vec3d middle(0.5 * SIZE, 0.5 * SIZE, 0.5 * SIZE);
        return osg::Matrixd::translate(-middle) *
               osg::Matrixd::rotate(angle, osg::Vec3d(0.3, 1.0, 0.5)) *
               osg::Matrixd::translate(middle + osg::Vec3d(3.0, 2.0, 1.0) * angle);
    }
    static MixedScene several(int count)
    {
        MixedScene scene;
        for (int i = 0; i < count; ++i)
            scene.addVolume(voxels(), i % 2 ? WARM : COLD, turned(0.4 * i));
        return scene;
    }
    static void addQuads(MixedScene& scene)
    {
        for (int i = 0; i < 3; ++i) {
            const float z = 6.0f + 6.0f * float(i);
            scene.addQuad({glm::vec3(-6, -6, z), {30, -6, z + 3}, {30, 30, z}, {-6, 30, z - 3}},
                          {0.9 - 0.3 * i, 0.3 * i, 0.4, 0.4});
        }
    }

    RenderOptions _options;

private:
    const std::optional<Kind> _asked = render::askedMarch();
};

} // namespace

TEST_F(March, OneVolumeOfEachKind)
{
    for (int kind = 0; kind < 8; ++kind) {
        SCOPED_TRACE(kind);
        MixedScene scene;
        VolumeAppearance& volume = scene.addVolume(voxels(), WARM);
        if (kind == 1) volume.setShading(true);
        if (kind == 2) volume.setLookup(A::PREINTEGRATED);
        if (kind == 3) volume.setInterpolation(A::CUBIC);
        if (kind == 4) volume.setLookup(A::BEFORE_INTERPOLATION);
        if (kind == 5) volume.setExactFiltering(true);
        if (kind == 6) {
            volume.setRayFunction(A::ISOSURFACE);
            volume.setIsoValue(0.6);
        }
        if (kind == 7) scene.setPeriod(0.5);
        compare(scene, _options);
    }
}

TEST_F(March, VolumesThatOverlapAndSurfacesInThem)
{
    for (int count : {1, 3})
        for (bool surfaces : {false, true}) {
            SCOPED_TRACE(std::to_string(count) + (surfaces ? " with surfaces" : ""));
            MixedScene scene = several(count);
            if (surfaces) addQuads(scene);
            // A march of what surfaces can touch, and one of the rest.
            compare(scene, _options, surfaces ? 2.0 : 1.0);
        }
}

TEST_F(March, EndsAtOpaqueGeometryAndPaints)
{
    MixedScene scene = several(1);
    scene.addVolume(voxels(), COLD, turned(0.7)).setCombineRule(A::PAINT);
    scene.addQuad({glm::vec3(-6, 12, -6), {30, 12, -6}, {30, 14, 30}, {-6, 10, 30}},
                  {0.8, 0.8, 0.2, 1.0}, true);
    compare(scene, _options);
}

TEST_F(March, FromWithinAndOrthographic)
{
    MixedScene scene = several(2);
    RenderOptions within = _options;
    within.lookAt({12, 11, 13}, {30, 14, 12}, {0, 0, 1});
    compare(scene, within);
    RenderOptions parallel = _options;
    parallel.orthographic(40.0);
    compare(scene, parallel);
}

// Fewer bits than the target has are rounded once, wherever the march came from.
TEST_F(March, IntoAWindowOfBytes)
{
    RenderOptions bytes = _options;
    bytes.format = support::PictureTarget::BYTE;
    compare(several(2), bytes, 1.0, 1.0 / 255.0 + 1e-6);
}

// What rays gather, and slices, are not for compute shaders.
TEST_F(March, OthersAreDrawnAsEver)
{
    MixedScene sum;
    sum.addVolume(voxels(), WARM).setRayFunction(A::MAXIMUM);
    compare(sum, _options, 0.0);
    MixedScene slices;
    slices.addVolume(voxels(), WARM).setTechnique(A::SLICES);
    compare(slices, _options, 0.0);
}

TEST_F(March, IsTheFasterOne)
{
    EXPECT_EQ(render::fasterMarch({1e-3, 7e-4}), Kind::COMPUTE);
    EXPECT_EQ(render::fasterMarch({1e-3, 9e-4}), Kind::FRAGMENTS);
    EXPECT_EQ(render::fasterMarch({0.0, 9e-4}), Kind::FRAGMENTS);
    EXPECT_EQ(render::fasterMarch({1e-3, 0.0}), Kind::FRAGMENTS);
    const auto withTimes = [&](const MarchTimes& times, MarchTimes* measured) {
        return support::prepared(_options, [times, measured](osgViewer::Viewer& viewer) {
            support::contextHooks(viewer).changeMarchTimes = [times, measured](MarchTimes& t) {
                if (measured) *measured = t;
                t = times;
            };
        });
    };
    MarchTimes measured;
    EXPECT_EQ(draw(several(2), withTimes({1e-3, 5e-4}, &measured), std::nullopt).computed, 1.0);
    EXPECT_GT(measured.fragments, 0.0);
    EXPECT_GT(measured.compute, 0.0);
    EXPECT_EQ(draw(several(2), withTimes({1e-3, 2e-3}, nullptr), std::nullopt).computed, 0.0);
    EXPECT_EQ(getLastError().text, "");
}

// A context that is lost while it is measured tells no time: a message, and fragments.
TEST_F(March, TimesThatAreNotKnown)
{
    expectFragments(
        [](render::ContextHooks& hooks) {
            hooks.changeMarchTimes = [](MarchTimes& times) { times = {}; };
        },
        std::nullopt, "could not be measured");
}

TEST_F(March, ShadersThatDoNotCompile)
{
    expectFragments(
        [](render::ContextHooks& hooks) { hooks.computeHeader = "#error of a compiler\n"; },
        Kind::COMPUTE, "compiler refuses a compute shader");
}

TEST_F(March, ContextsWithoutComputeShaders)
{
    const RenderOptions old =
        support::limited(_options, [](render::ContextLimits& limits) { limits.version = 4.2; });
    EXPECT_EQ(draw(several(2), old, std::nullopt).computed, 0.0);
    EXPECT_EQ(getLastError().text, "");
    EXPECT_EQ(draw(several(2), old, Kind::COMPUTE).computed, 0.0);
    EXPECT_NE(getLastError().text.find("no OpenGL 4.3"), std::string::npos) << getLastError().text;
}

} // namespace MarchTest
