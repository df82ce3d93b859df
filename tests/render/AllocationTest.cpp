// What is drawn when the card has no memory for what is drawn into.

#include "Volumes.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/render/context/Allocation.h>

#include <support/GLTest.h>
#include <support/Shapes.h>

namespace AllocationTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using render::AllocationRequest;
using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;

namespace {

RenderOptions view()
{
    RenderOptions options = RenderOptions().size(80, 80).perspective(45.0).lookAt(
        {40, -20, 30}, {12, 10, 8}, {0, 0, 1});
    options.format = PictureTarget::BYTE;
    return options;
}

bool isDepth(GLenum format)
{
    return format != GL_RGBA32F_ARB && format != GL_RGBA16F_ARB && format != GL_RGBA8;
}

class Messages : public ErrorHandler
{
public:
    void operator()(const Status& status) override { texts.push_back(status.text); }
    std::vector<std::string> texts;
};

class TargetAllocation : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        const osg::ref_ptr<Voxels> voxels = makeVoxels({25, 21, 17}, bumps);
        _volume = makeTwin(voxels, smoothPoints(0.1)).node;
        _other = makeTwin(voxels, smoothPoints(0.07)).node;
        _opaque = support::makeQuad({osg::Vec3(-5, 2, -5), {30, 8, 2}, {28, 14, 20}, {-4, 12, 18}},
                                    {0.2f, 0.7f, 0.3f, 1.0f});
        _translucent =
            support::makeQuad({osg::Vec3(-5, 15, -5), {30, 3, 0}, {28, 8, 20}, {-4, 18, 18}},
                              {0.8f, 0.3f, 0.1f, 0.5f}, true);
        setErrorHandler(_messages);
    }
    void TearDown() override { setErrorHandler(nullptr); }

    // The last of some frames, of which the first finds out what there is no memory for.
    FloatImage show(const std::vector<osg::Node*>& nodes, unsigned frames,
                    const std::function<bool(const AllocationRequest&)>& isRefused = {})
    {
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        for (osg::Node* node : nodes)
            scene->addChild(node);
        RenderOptions options = support::refusing(view(), isRefused);
        options.frames = frames;
        support::SceneRenderer renderer(scene, options);
        const FloatImage image = renderer.render();
        EXPECT_EQ(renderer.glError(), 0u);
        return image;
    }
    FloatImage showWithout(const std::function<bool(const AllocationRequest&)>& isRefused,
                           const std::vector<osg::Node*>& nodes, unsigned frames)
    {
        _messages->texts.clear();
        _refusals = 0;
        const auto refuse = [this, isRefused](const AllocationRequest& request) {
            const bool refused = request.kind == AllocationRequest::TARGET && isRefused(request);
            _refusals += refused;
            return refused;
        };
        const FloatImage image = show(nodes, frames, refuse);
        EXPECT_GT(_refusals, 0);
        return image;
    }
    // A half-transparent surface shifts by its piece of the volume, at most.
    void expectNear(const FloatImage& image, const FloatImage& expected, double rmse) const
    {
        EXPECT_GT(support::coveredPixels(image, 0.1f).count(), 800u);
        EXPECT_LE(compare(image, expected).rmse, rmse);
    }

    osg::ref_ptr<VolumeAppearance> _volume, _other;
    osg::ref_ptr<osg::Node> _opaque, _translucent;
    const osg::ref_ptr<Messages> _messages = new Messages;
    int _refusals = 0;
};

TEST_F(TargetAllocation, AFloatTargetIsReplacedByOneOfFewerBits)
{
    const FloatImage expected = show({_volume, _opaque}, 1);
    for (const unsigned frames : {1u, 3u}) {
        const FloatImage halves = showWithout(
            [](const AllocationRequest& r) { return r.internalFormat == GL_RGBA32F_ARB; },
            {_volume, _opaque}, frames);
        EXPECT_LE(compare(halves, expected).maximum, 2.0 / 255.0);
        const FloatImage bytes = showWithout(
            [](const AllocationRequest& r) {
                return r.internalFormat == GL_RGBA32F_ARB || r.internalFormat == GL_RGBA16F_ARB;
            },
            {_volume, _opaque}, frames);
        EXPECT_LE(compare(bytes, expected).maximum, 3.0 / 255.0);
        EXPECT_LE(_messages->texts.size(), 1u); // each is said once in a process
    }
}

TEST_F(TargetAllocation, WithoutATargetVolumesAreDrawnToTheFramebuffer)
{
    const FloatImage expected = show({_volume, _opaque}, 1);
    for (const unsigned frames : {1u, 3u}) {
        const FloatImage image =
            showWithout([](const AllocationRequest& r) { return !isDepth(r.internalFormat); },
                        {_volume, _opaque}, frames);
        EXPECT_LE(compare(image, expected).maximum, 3.0 / 255.0);
        EXPECT_LE(_messages->texts.size(), 1u); // each is said once in a process
    }
}

TEST_F(TargetAllocation, WithoutACopyOfDepthFacesAreStillTested)
{
    const FloatImage expected = show({_volume}, 1);
    const FloatImage image =
        showWithout([](const AllocationRequest&) { return true; }, {_volume}, 2);
    EXPECT_LE(compare(image, expected).maximum, 3.0 / 255.0);
    // Nothing of a volume that lies behind opaque geometry is seen.
    const osg::ref_ptr<osg::Node> wall =
        support::makeQuad({osg::Vec3(28, -40, -40), {28, 60, -40}, {28, 60, 60}, {28, -40, 60}},
                          {0.2f, 0.7f, 0.3f, 1});
    const FloatImage alone = show({wall}, 1);
    EXPECT_EQ(
        compare(showWithout([](const AllocationRequest&) { return true; }, {_volume, wall}, 2),
                alone)
            .maximum,
        0.0);
}

TEST_F(TargetAllocation, SurfacesAreSortedWhereTheyCannotBeCaptured)
{
    const FloatImage expected = show({_volume, _translucent}, 1);
    const auto captureOnly = [](const AllocationRequest& r) { return r.size.z > 1; };
    // The frame that finds out draws the surface after the volume; the next ones are right.
    expectNear(showWithout(captureOnly, {_volume, _translucent}, 1), expected, 0.12);
    EXPECT_LE(_messages->texts.size(), 1u); // each is said once in a process
    expectNear(showWithout(captureOnly, {_volume, _translucent}, 3), expected, 3e-3);
    EXPECT_EQ(_messages->texts.size(), 0u);
}

TEST_F(TargetAllocation, SurfacesAreDrawnByIntervalsWhereTheyCannotBeSorted)
{
    // Surfaces that are not captured are sorted in ranks; without ranks by intervals of depth.
    const FloatImage expected = show({_volume, _other, _translucent}, 1);
    const auto layers = [](const AllocationRequest& r) {
        return r.size.z > 1 || r.internalFormat == GL_DEPTH32F_STENCIL8;
    };
    expectNear(showWithout(layers, {_volume, _other, _translucent}, 1), expected, 0.12);
    EXPECT_LE(_messages->texts.size(), 1u); // each is said once in a process
    expectNear(showWithout(layers, {_volume, _other, _translucent}, 3), expected, 6e-3);
}

TEST_F(TargetAllocation, WithoutSplitsOfIntervalsSurfacesStayWhole)
{
    const auto all = [](const AllocationRequest& r) {
        return r.size.z > 1 || r.internalFormat == GL_DEPTH32F_STENCIL8;
    };
    const FloatImage expected = show({_volume, _other, _translucent}, 1);
    expectNear(showWithout(all, {_volume, _other, _translucent}, 3), expected, 6e-3);
}

TEST_F(TargetAllocation, GatheredRaysAreLeftOutWithAMessage)
{
    _volume->setRayFunction(VolumeAppearance::MAXIMUM);
    const FloatImage alone = show({_opaque}, 1);
    int count = 0;
    // The target comes first, then that of rays.
    const FloatImage image = showWithout(
        [&count](const AllocationRequest& r) {
            return r.internalFormat == GL_RGBA32F_ARB && ++count > 1;
        },
        {_volume, _opaque}, 1);
    EXPECT_LE(compare(image, alone).maximum, 1e-6);
    EXPECT_LE(_messages->texts.size(), 1u); // each is said once in a process
}

} // namespace

} // namespace AllocationTest
