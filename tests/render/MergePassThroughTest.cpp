// What the merger leaves alone: scenes without a volume to see, and what applications do with bins.

#include "MixedScene.h"

#include <support/GLTest.h>

#include <osg/Depth>
#include <osgUtil/CullVisitor>

namespace MergePassThroughTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis
const Points THIN = {{0.0, {0.1, 0.3, 0.9, 0.01}}, {1.0, {1.0, 0.4, 0.1, 0.1}}};

RenderOptions viewOf(support::PictureTarget::Format format = support::PictureTarget::FLOAT32)
{
    RenderOptions options;
    options.size(128, 128).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    options.format = format;
    return options;
}

osg::ref_ptr<osg::Group> surfaces()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(makeGeometry(sphereMesh({16, 16, 16}, 9.0, 24, 12), {0.1, 0.9, 0.2, 0.6}));
    group->addChild(
        makeGeometry(quadMesh({glm::vec3(-5, -3, 2), {37, 0, 6}, {40, 36, 30}, {-4, 30, 25}}),
                     {0.9, 0.1, 0.2, 0.4}));
    return group;
}

osg::ref_ptr<VolumeAppearance> volume(const Points& points = THIN)
{
    osg::ref_ptr<VolumeAppearance> node = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    node->setLookupTable(makeTable(points));
    return node;
}

class PassThrough : public support::GLTest
{
protected:
    // Pixels, bit by bit, and depth; `extra` beside the surfaces shows nothing.
    void expectUnchanged(osg::Node* extra) const
    {
        for (const auto format : {support::PictureTarget::FLOAT32, support::PictureTarget::BYTE}) {
            RenderOptions options = viewOf(format);
            options.depth = true;
            const osg::ref_ptr<osg::Group> scene = surfaces();
            const FloatImage plain = support::renderScene(scene, options);
            scene->addChild(extra);
            support::SceneRenderer renderer(scene, options);
            const FloatImage picture = renderer.render();
            EXPECT_EQ(picture.pixels, plain.pixels);
            EXPECT_EQ(picture.depth, plain.depth);
            for (const auto& counter : renderer.counters())
                EXPECT_TRUE(counter.first == "osgVolumizer bricks total" ||
                            counter.first == "osgVolumizer bricks empty" || counter.second == 0.0)
                    << counter.first;
            ASSERT_GT(support::coveredPixels(plain).count(), 1000u);
        }
    }
};

TEST_F(PassThrough, VolumeOutsideTheView)
{
    expectUnchanged(MixedScene::placed(volume(), osg::Matrixd::translate(0, 0, 500)));
}

TEST_F(PassThrough, HiddenVolume)
{
    const osg::ref_ptr<VolumeAppearance> node = volume();
    node->setNodeMask(0);
    expectUnchanged(node);
}

TEST_F(PassThrough, VolumeWithoutOpacity)
{
    expectUnchanged(volume(constantPoints({1.0, 1.0, 1.0, 0.0})));
}

TEST_F(PassThrough, VolumeWithoutVoxels)
{
    osg::ref_ptr<VolumeAppearance> node = new VolumeAppearance;
    node->addChild(VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 32, 32, 32)));
    expectUnchanged(node);
}

// A volume that reaches nothing leaves others' pixels as they were.
TEST_F(PassThrough, VolumeBesideTheSurfaces)
{
    const osg::ref_ptr<osg::Group> scene = surfaces();
    const RenderOptions options = viewOf();
    const FloatImage plain = support::renderScene(scene, options);
    const osg::ref_ptr<osg::Node> small = MixedScene::placed(
        volume(), osg::Matrixd::scale(0.1, 0.1, 0.1) * osg::Matrixd::translate(16, 16, -14));
    osg::ref_ptr<osg::Group> alone = new osg::Group;
    alone->addChild(small);
    scene->addChild(small);
    const FloatImage picture = support::renderScene(scene, options);
    const FloatImage covered = support::renderScene(alone, options);
    ASSERT_GT(support::coveredPixels(covered).count(), 10u);
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        if (covered.pixels[i].a == 0.0f) {
            ASSERT_EQ(picture.pixels[i], plain.pixels[i]) << i;
        }
}

/// An application's own callback: counts leaves, and sorts as the bin would.
struct CountingSort : osgUtil::RenderBin::SortCallback
{
    void sortImplementation(osgUtil::RenderBin* bin) override
    {
        bin->sortImplementation();
        ++calls;
        leaves = bin->getRenderLeafList().size();
    }
    int calls = 0;
    std::size_t leaves = 0;
};

/// Installs it in the bin that the group's own state selects, before the children are culled.
struct InstallSort : osg::NodeCallback
{
    explicit InstallSort(CountingSort* s) : sort(s) {}
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        auto* cull = dynamic_cast<osgUtil::CullVisitor*>(visitor);
        if (cull) cull->getCurrentRenderBin()->setSortCallback(sort);
        traverse(node, visitor);
    }
    osg::ref_ptr<CountingSort> sort;
};

TEST_F(PassThrough, SortCallbackOfTheApplicationStillRuns)
{
    const osg::ref_ptr<osg::Group> scene = surfaces();
    scene->addChild(volume());
    const FloatImage before = support::renderScene(scene, viewOf());
    const osg::ref_ptr<CountingSort> sort = new CountingSort;
    osg::ref_ptr<osg::Group> installer = new osg::Group;
    installer->getOrCreateStateSet()->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    installer->setCullCallback(new InstallSort(sort));
    scene->insertChild(0, installer);
    const FloatImage after = support::renderScene(scene, viewOf());
    EXPECT_EQ(sort->calls, 1);
    EXPECT_EQ(sort->leaves, 3u);
    EXPECT_EQ(after.pixels, before.pixels);
}

// Everything of a scene below a group with a bin of its own.
TEST_F(PassThrough, NestedBinsShowTheSame)
{
    const osg::ref_ptr<osg::Group> scene = surfaces();
    scene->addChild(volume());
    const FloatImage flat = support::renderScene(scene, viewOf());
    for (const char* bin : {"RenderBin", "DepthSortedBin"}) {
        scene->getOrCreateStateSet()->setRenderBinDetails(5, bin);
        const FloatImage nested = support::renderScene(scene, viewOf());
        EXPECT_LE(support::compare(nested, flat).maximum, 1e-5) << bin;
        support::savePicture(nested, std::string("merge_nested_") + bin);
    }
}

// Two such groups, each a scene of its own, one drawn over the other.
TEST_F(PassThrough, BinsSideBySideAreDrawnInTheirOrder)
{
    const auto part = [](int number, const osg::Matrixd& place) {
        const osg::ref_ptr<osg::Group> group = surfaces();
        group->addChild(volume());
        const osg::ref_ptr<osg::Node> placed = MixedScene::placed(group, place);
        placed->getOrCreateStateSet()->setRenderBinDetails(number, "RenderBin");
        return placed;
    };
    const osg::Matrixd aside = osg::Matrixd::translate(-12, 8, 0);
    osg::ref_ptr<osg::Group> first = new osg::Group, second = new osg::Group, both = new osg::Group;
    first->addChild(part(11, osg::Matrixd()));
    second->addChild(part(12, aside));
    both->addChild(part(12, aside)); // whatever the order of nodes
    both->addChild(part(11, osg::Matrixd()));
    for (const auto& group : {first, second, both}) // surfaces of one must not hide the other
        group->getOrCreateStateSet()->setAttributeAndModes(
            new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false), osg::StateAttribute::OVERRIDE);
    const FloatImage under = support::renderScene(first, viewOf());
    const FloatImage over = support::renderScene(second, viewOf());
    const FloatImage picture = support::renderScene(both, viewOf());
    FloatImage expected = over;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i)
        expected.pixels[i] += (1.0f - over.pixels[i].a) * under.pixels[i];
    support::savePicture(picture, "merge_bins");
    support::savePicture(expected, "merge_bins_expected");
    EXPECT_LE(support::compare(picture, expected).maximum, 1e-4);
}

// What translucent surfaces write to the depth buffer is there for what is drawn after.
TEST_F(PassThrough, DepthWritesReachTheFramebuffer)
{
    RenderOptions options = viewOf();
    options.depth = true;
    const osg::ref_ptr<osg::Group> scene = surfaces();
    const FloatImage plain = support::renderScene(scene, options);
    scene->addChild(volume());
    const FloatImage merged = support::renderScene(scene, options);
    ASSERT_EQ(plain.depth.size(), merged.depth.size());
    // Near and far are moved to the scene, which the volume makes no larger.
    std::size_t wrong = 0, written = 0;
    for (std::size_t i = 0; i < plain.depth.size(); ++i) {
        written += plain.depth[i] < 1.0f;
        wrong += std::abs(plain.depth[i] - merged.depth[i]) > 1e-6f;
    }
    EXPECT_GT(written, 1000u);
    EXPECT_EQ(wrong, 0u);
}

// Depth that grows towards the eye cannot be merged, and is left alone.
TEST_F(PassThrough, ReversedDepthTestsAreNotMerged)
{
    const osg::ref_ptr<osg::Group> scene = surfaces();
    scene->addChild(volume());
    support::SceneRenderer usual(scene, viewOf());
    EXPECT_FALSE(usual.render().empty());
    EXPECT_GT(usual.counters()["osgVolumizer surface pieces"], 0.0);
    scene->getChild(0)->getOrCreateStateSet()->setAttributeAndModes(
        new osg::Depth(osg::Depth::GREATER));
    scene->getChild(1)->getOrCreateStateSet()->setAttributeAndModes(
        new osg::Depth(osg::Depth::GEQUAL));
    support::SceneRenderer reversed(scene, viewOf());
    EXPECT_FALSE(reversed.render().empty());
    EXPECT_EQ(reversed.counters()["osgVolumizer surface pieces"], 0.0);
    EXPECT_EQ(reversed.glError(), 0u);
}

} // namespace

} // namespace MergePassThroughTest
