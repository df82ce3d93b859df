// Surfaces that are captured and composited while the volume is marched: many layers, large meshes,
// and none of the marks that slabs could leave.

#include "MixedScene.h"

#include <support/GLTest.h>

#include <osg/Billboard>
#include <osg/BlendFunc>

namespace MergeCaptureTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis
const glm::dvec3 MIDDLE(0.5 * (SIZE - 1));
const Points WARM = {{0.0, {0.1, 0.3, 0.9, 0.02}}, {1.0, {1.0, 0.4, 0.1, 0.2}}};
const Points THIN = {{0.0, {0.1, 0.3, 0.9, 0.002}}, {1.0, {1.0, 0.4, 0.1, 0.03}}};

void append(Mesh& mesh, const Mesh& other)
{
    const unsigned first = static_cast<unsigned>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
    for (auto t : other.triangles) {
        for (auto& corner : t)
            corner += first;
        mesh.triangles.push_back(t);
    }
}

class MergeCapture : public support::GLTest
{
protected:
    MergeCapture()
    {
        _options.size(96, 96).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
        _scene.addVolume(_voxels, THIN);
    }
    // Exact but for the volume's own sampling, which in thin volumes is far below the bounds.
    void expectExact(const std::string& name)
    {
        support::SceneRenderer renderer(_scene.root(), _options);
        renderer.render();
        // No interval had to be made.
        EXPECT_LE(renderer.counters()["osgVolumizer intervals"], 1.0);
        const Judged j = judge(_scene, _options);
        save(j, "merge_capture_" + name);
        EXPECT_GT(j.away.pixels, 1500u);
        EXPECT_LE(j.all.rmse, 1e-3);
        EXPECT_LE(j.away.maximum, 1e-3);
    }

    osg::ref_ptr<Voxels> _voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    MixedScene _scene;
    RenderOptions _options;
};

TEST_F(MergeCapture, TwentyPlanes)
{
    for (int i = 0; i < 20; ++i) {
        const float z = 1.0f + 1.5f * static_cast<float>(i * 7 % 20); // in no order
        _scene.addQuad({glm::vec3(-3, -3, z), {35, -3, z}, {35, 35, z + 1}, {-3, 35, z + 1}},
                       {0.05 * i, 0.9 - 0.04 * i, 0.5, 0.1 + 0.02 * (i % 5)});
    }
    expectExact("planes");
}

// One mesh of many layers, which drawing order by itself gets wrong.
TEST_F(MergeCapture, NestedShellsInOneMesh)
{
    Mesh mesh;
    for (const double radius : {13.0, 10.0, 6.0})
        append(mesh, sphereMesh(MIDDLE, radius, 64, 32));
    ASSERT_GT(mesh.triangles.size(), 10000u);
    _scene.addMesh(mesh, {0.2, 0.9, 0.3, 0.3});
    expectExact("shells");
}

TEST_F(MergeCapture, BricksThatShareATexture)
{
    ASSERT_TRUE(_voxels->setBrickSize({9, 9, 9}));
    for (const double radius : {13.0, 6.0})
        _scene.addMesh(sphereMesh(MIDDLE, radius, 64, 32), {0.2, 0.9, 0.3, 0.3});
    expectExact("bricks");
}

TEST_F(MergeCapture, LargeAndSmallMeshes)
{
    for (int i = 0; i < 5; ++i)
        _scene.addMesh(sphereMesh({6.0 + 5 * i, 10.0 + 3 * i, 12.0 + 2 * i}, 6.0, 48, 32),
                       {0.2 * i, 0.9, 0.3, 0.4});
    _scene.addQuad({glm::vec3(-4, 16, -4), {36, 16, -4}, {36, 16, 36}, {-4, 16, 36}},
                   {0.9, 0.1, 0.2, 0.4});
    _scene.addMesh(sphereMesh({24, 20, 8}, 5.0, 12, 6), {0.1, 0.2, 0.9, 0.5});
    expectExact("meshes");
}

TEST_F(MergeCapture, PremultipliedColors)
{
    osg::Geometry& sphere = _scene.addMesh(sphereMesh(MIDDLE, 9.0, 48, 32), {0.2, 0.9, 0.3, 0.4});
    auto& color = (*static_cast<osg::Vec4Array*>(sphere.getColorArray()))[0];
    color =
        osg::Vec4(color.r() * color.a(), color.g() * color.a(), color.b() * color.a(), color.a());
    sphere.getOrCreateStateSet()->setAttributeAndModes(
        new osg::BlendFunc(osg::BlendFunc::ONE, osg::BlendFunc::ONE_MINUS_SRC_ALPHA));
    expectExact("premultiplied");
}

// A plane that slowly leaves the view's depth crosses every slab there could be: no bands.
TEST_F(MergeCapture, SlantedQuadShowsNoBands)
{
    MixedScene scene;
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM);
    scene.addQuad({glm::vec3(-20, 16, 15), {52, 16, 15}, {52, 17, 19}, {-20, 17, 19}},
                  {0.1, 0.9, 0.2, 0.5});
    scene.addQuad({glm::vec3(-20, -10, 11), {52, -10, 13}, {52, 40, 19}, {-20, 40, 17}},
                  {0.9, 0.1, 0.2, 0.5});
    RenderOptions options;
    options.size(128, 128).perspective(40.0).lookAt({16, -50, 24}, {16, 16, 16}, {0, 0, 1});
    const Judged j = judge(scene, options);
    save(j, "merge_capture_bands");
    EXPECT_GT(j.away.pixels, 2000u);
    EXPECT_LE(j.away.maximum, 1.0 / 255.0);
}

// Every drawable of a billboard has a model-view of its own.
TEST_F(MergeCapture, Billboards)
{
    const auto quadAt = [](const glm::vec3& c, float half, const glm::vec3& right,
                           const glm::vec3& up) {
        return std::array<glm::vec3, 4>{c - half * right - half * up, c + half * right - half * up,
                                        c + half * right + half * up, c - half * right + half * up};
    };
    // From far away along y: billboards turn to the eye, and so to planes of constant y.
    _options.lookAt({16, -6000, 16}, {16, 16, 16}, {0, 0, 1}).orthographic(24.0);
    osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
    billboard->setMode(osg::Billboard::POINT_ROT_EYE);
    billboard->setNormal(osg::Vec3(0, -1, 0));
    for (int i = 0; i < 4; ++i) {
        const glm::vec3 place(10 + 4 * i, 5 + 6 * i, 12 + 3 * i);
        const glm::dvec4 color(0.2 * i, 0.8, 0.3, 0.4);
        billboard->addDrawable(
            makeGeometry(quadMesh(quadAt(glm::vec3(0.0f), 6.0f, {1, 0, 0}, {0, 0, 1})), color),
            osg::Vec3(place.x, place.y, place.z));
        _scene.addTruth(quadMesh(quadAt(place, 6.0f, {1, 0, 0}, {0, 0, 1})), color);
    }
    _scene.root()->addChild(billboard);
    expectExact("billboards");
}

} // namespace

} // namespace MergeCaptureTest
