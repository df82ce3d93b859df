// Leaves of every kind in a volume. Each lies in one plane, so what the merged picture must be
// follows from the leaf's picture without the volume, P, and from what the oracle sees in front of
// and behind the plane: front + T_front * (P.rgb + (1 - P.a) * behind).

#include "MergeLeaves.h"
#include "MixedScene.h"

#include <support/GLTest.h>

namespace MergeDrawableTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis
const Points THIN = {{0.0, {0.1, 0.3, 0.9, 0.01}}, {1.0, {1.0, 0.4, 0.1, 0.1}}};

// The plane z = 0 of leaves, 32 by 32, slanted through the middle of the volume.
osg::Matrixd placement()
{
    return osg::Matrixd::translate(-16, -16, 0) *
           osg::Matrixd::rotate(0.5, osg::Vec3d(1, 0.3, 0.2)) * osg::Matrixd::translate(16, 16, 16);
}

RenderOptions viewOf()
{
    RenderOptions options;
    options.size(160, 160).perspective(40.0).lookAt({40, -30, 75}, {16, 16, 16}, {0, 0, 1});
    options.frames = 3; // what moves its vertices does so in the first update
    return options;
}

/// The volume as the oracle sees it in front of the plane and behind it, premultiplied.
struct Halves
{
    FloatImage front, behind;
};

glm::vec4 over(const glm::vec4& a, const glm::vec4& b)
{
    return a + (1.0f - a.a) * b;
}

class Leaves : public support::GLTest, public ::testing::WithParamInterface<LeafKind>
{
protected:
    static const oracle::Volume& volume()
    {
        static const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
        static const oracle::Volume v =
            oracle::voxelVolume(gridOf(*voxels), glm::ivec3(SIZE), oracle::Table(THIN));
        return v;
    }
    static const Halves& halves()
    {
        static const Halves h = [] {
            const glm::dmat4 m = support::toGlm(placement());
            const glm::dvec3 normal = glm::normalize(glm::dvec3(m[2])), on(m[3]);
            Halves r;
            // The eye is above the plane.
            for (const double side : {1.0, -1.0}) {
                oracle::Volume half = volume();
                half.region.push_back({side * normal, -side * glm::dot(normal, on)});
                (side > 0.0 ? r.front : r.behind) = oraclePicture(oracleScene(half), viewOf());
            }
            return r;
        }();
        return h;
    }
    static osg::ref_ptr<osg::Group> sceneOf(osg::Node* leaf)
    {
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(MixedScene::placed(leaf, placement()));
        return scene;
    }
    static osg::ref_ptr<VolumeAppearance> volumeNode(const Points& points)
    {
        osg::ref_ptr<VolumeAppearance> node = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
        node->setLookupTable(makeTable(points));
        return node;
    }
    static RenderOptions optionsFor(const LeafKind& kind)
    {
        RenderOptions options = viewOf();
        options.light = kind.light;
        return options;
    }
};

TEST_P(Leaves, LieBetweenFrontAndBehind)
{
    const RenderOptions options = optionsFor(GetParam());
    const osg::ref_ptr<osg::Group> scene = sceneOf(GetParam().make());
    const FloatImage plain = support::renderScene(scene, options);
    const std::size_t covered = support::coveredPixels(plain).count();
    ASSERT_GE(covered, 100u);

    scene->addChild(volumeNode(THIN));
    support::SceneRenderer renderer(scene, options);
    const FloatImage merged = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    FloatImage expected = plain;
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        expected.pixels[i] = over(halves().front.pixels[i],
                                  GetParam().blend(plain.pixels[i], halves().behind.pixels[i]));
    const support::Mask away = awayFromSilhouettes(oracleScene(volume()), options);
    const support::Difference d = support::compare(merged, expected, away);
    std::printf("  %zu pixels: rmse %.2e, maximum %.2e at %d %d\n", covered, d.rmse, d.maximum,
                d.worstX, d.worstY);
    support::savePicture(merged, std::string("merge_leaf_") + GetParam().name);
    support::savePicture(expected, std::string("merge_leaf_") + GetParam().name + "_expected");
    EXPECT_LE(d.rmse, 4e-4);
    EXPECT_LE(d.maximum, 1e-2);
}

// In a volume that shows nothing, and splits leaves nevertheless, nothing changes.
TEST_P(Leaves, AreUnchangedByATransparentVolume)
{
    const RenderOptions options = optionsFor(GetParam());
    const osg::ref_ptr<osg::Group> scene = sceneOf(GetParam().make());
    const FloatImage plain = support::renderScene(scene, options);
    osg::ref_ptr<VolumeAppearance> volume = volumeNode(constantPoints({1.0, 1.0, 1.0, 1e-7}));
    volume->setSamplingPeriod(osg::Vec3d(0.5, 0.5, 0.5));
    scene->addChild(volume);
    const FloatImage merged = support::renderScene(scene, options);
    const support::Difference d = support::compare(merged, plain);
    std::printf("  maximum %.2e at %d %d\n", d.maximum, d.worstX, d.worstY);
    EXPECT_LE(d.maximum, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, Leaves, ::testing::ValuesIn(leafKinds()),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace

} // namespace MergeDrawableTest
