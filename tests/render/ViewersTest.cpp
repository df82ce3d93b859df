// Stereo, slave cameras, several views, contexts and threads: all show what one plain viewer shows.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Precision.h>

#include <osg/ColorMask>
#include <osg/DisplaySettings>
#include <osgViewer/CompositeViewer>

namespace ViewersTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;

namespace {

constexpr int WIDTH = 64, HEIGHT = 56;

RenderOptions view(const osg::Vec3d& eye = osg::Vec3d(40, -20, 30))
{
    return RenderOptions()
        .size(WIDTH, HEIGHT)
        .perspective(45.0)
        .lookAt(eye, {12, 10, 8}, {0, 0, 1});
}

TwinVolume makeScene()
{
    osg::ref_ptr<Voxels> voxels = makeVoxels({25, 21, 17}, bumps);
    voxels->setBrickSize({13, 13, 13});
    return makeTwin(voxels, smoothPoints(0.1));
}

osg::ref_ptr<osg::GraphicsContext> makeContext()
{
    return new support::SurfacelessGraphicsContext(WIDTH, HEIGHT);
}

// A camera of a viewer, and what it drew.
struct Window
{
    osg::ref_ptr<osg::Camera> camera;
    osg::ref_ptr<PictureTarget> target;

    Window(osg::Camera* c, osg::GraphicsContext* context) : camera(c)
    {
        camera->setGraphicsContext(context);
        camera->setProjectionResizePolicy(osg::Camera::FIXED);
        camera->setClearColor({0, 0, 0, 0});
        target = new PictureTarget(*camera, WIDTH, HEIGHT);
    }
    void look(const RenderOptions& options) const
    {
        camera->setViewMatrix(options.view);
        camera->setProjectionMatrix(options.projection);
    }
};

using Viewers = support::GLTest;

// One channel of two pictures.
double channelDifference(const FloatImage& a, const FloatImage& b, int channel)
{
    double largest = a.pixels.size() == b.pixels.size() ? 0.0 : 1e30;
    for (std::size_t i = 0; i < a.pixels.size() && i < b.pixels.size(); ++i)
        largest = std::max(largest, double(std::abs(a.pixels[i][channel] - b.pixels[i][channel])));
    return largest;
}

// The view of one eye, as OSG's scene view makes it.
RenderOptions eyeView(const osg::DisplaySettings& settings, const RenderOptions& options, bool left)
{
    RenderOptions eye = options;
    eye.view = left ? settings.computeLeftEyeViewImplementation(options.view, 1.0)
                    : settings.computeRightEyeViewImplementation(options.view, 1.0);
    eye.projection = left ? settings.computeLeftEyeProjectionImplementation(options.projection)
                          : settings.computeRightEyeProjectionImplementation(options.projection);
    return eye;
}

FloatImage stereoPicture(TwinVolume& twin, osg::DisplaySettings* settings,
                         const RenderOptions& options)
{
    support::SceneRenderer renderer(twin.node, options);
    renderer.viewer().getCamera()->setDisplaySettings(settings);
    renderer.viewer().setFusionDistance(osgUtil::SceneView::PROPORTIONAL_TO_SCREEN_DISTANCE, 1.0f);
    const FloatImage image = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    return image;
}

double toleranceOf(PictureTarget::Format format)
{
    return format == PictureTarget::BYTE ? 0.51 / 255.0 : 1e-5;
}

TEST_F(Viewers, BothEyesOfStereo)
{
    TwinVolume twin = makeScene();
    // The eyes' matrices are rounded otherwise here: some samples would have other weights.
    support::filterExactly(*twin.node);
    osg::ref_ptr<osg::DisplaySettings> settings = new osg::DisplaySettings;
    settings->setStereo(true);
    settings->setScreenDistance(0.5f);
    settings->setEyeSeparation(0.6f);
    const FloatImage left = support::renderScene(twin.node, eyeView(*settings, view(), true));
    const FloatImage right = support::renderScene(twin.node, eyeView(*settings, view(), false));
    ASSERT_GT(compare(left, right).maximum, 0.05);
    for (const auto format : {PictureTarget::FLOAT32, PictureTarget::BYTE}) {
        RenderOptions options = view();
        options.format = format;
        settings->setStereoMode(osg::DisplaySettings::LEFT_EYE);
        EXPECT_LE(compare(stereoPicture(twin, settings, options), left).maximum,
                  toleranceOf(format));
        settings->setStereoMode(osg::DisplaySettings::RIGHT_EYE);
        EXPECT_LE(compare(stereoPicture(twin, settings, options), right).maximum,
                  toleranceOf(format));
        // Of the other modes OSG draws the left eye only, where a camera renders to a framebuffer
        // object: red here, the left half there.
        settings->setStereoMode(osg::DisplaySettings::ANAGLYPHIC);
        const FloatImage anaglyph = stereoPicture(twin, settings, options);
        support::savePicture(anaglyph, "viewers_anaglyph");
        EXPECT_LE(channelDifference(anaglyph, left, 0), toleranceOf(format));
    }
}

TEST_F(Viewers, SplitStereo)
{
    TwinVolume twin = makeScene();
    osg::ref_ptr<osg::DisplaySettings> settings = new osg::DisplaySettings;
    settings->setStereo(true);
    settings->setStereoMode(osg::DisplaySettings::HORIZONTAL_SPLIT);
    settings->setSplitStereoHorizontalSeparation(0);
    settings->setSplitStereoAutoAdjustAspectRatio(false);
    RenderOptions half = eyeView(*settings, view(), true);
    half.width = WIDTH / 2;
    const FloatImage left = support::renderScene(twin.node, half);
    const FloatImage image = stereoPicture(twin, settings, view());
    support::savePicture(image, "viewers_split");
    FloatImage cut(WIDTH / 2, HEIGHT);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH / 2; ++x)
            cut.at(x, y) = image.at(x, y);
    EXPECT_GT(support::coveredPixels(cut, 0.3f).count(), 300u);
    EXPECT_LE(compare(cut, left).maximum, 1e-5);
}

TEST_F(Viewers, ColourMasksArePassedOn)
{
    // What an anaglyph needs of each eye: other channels keep what was there.
    TwinVolume twin = makeScene();
    for (const auto format : {PictureTarget::FLOAT32, PictureTarget::BYTE}) {
        RenderOptions options = view();
        options.background = osg::Vec4(0.2f, 0.4f, 0.6f, 1.0f);
        const FloatImage plain = support::renderScene(twin.node, options);
        options.format = format;
        support::SceneRenderer renderer(twin.node, options);
        osg::ref_ptr<osg::ColorMask> mask = new osg::ColorMask(true, false, false, true);
        twin.node->getOrCreateStateSet()->setAttribute(mask, osg::StateAttribute::OVERRIDE);
        const FloatImage red = renderer.render();
        twin.node->setStateSet(nullptr);
        EXPECT_LE(channelDifference(red, plain, 0), toleranceOf(format));
        const FloatImage background(WIDTH, HEIGHT, glm::vec4(0.2f, 0.4f, 0.6f, 1.0f));
        EXPECT_LE(channelDifference(red, background, 1), toleranceOf(format));
        EXPECT_LE(channelDifference(red, background, 2), toleranceOf(format));
        EXPECT_GT(channelDifference(plain, background, 2), 0.1);
    }
}

TEST_F(Viewers, PartOfTheTarget)
{
    TwinVolume twin = makeScene();
    const int x0 = 11, y0 = 17, width = 40, height = 30;
    RenderOptions small = view();
    small.size(width, height);
    const FloatImage expected = support::renderScene(twin.node, small);
    EXPECT_GT(support::coveredPixels(expected, 0.3f).count(), 100u);
    for (const auto format : {PictureTarget::FLOAT32, PictureTarget::BYTE}) {
        RenderOptions options = view();
        options.format = format;
        options.projection = small.projection;
        support::SceneRenderer renderer(twin.node, options);
        renderer.viewer().getCamera()->setViewport(x0, y0, width, height);
        const FloatImage image = renderer.render();
        FloatImage cut(width, height);
        double outside = 0.0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x) {
                const bool inside = x >= x0 && x < x0 + width && y >= y0 && y < y0 + height;
                if (inside)
                    cut.at(x - x0, y - y0) = image.at(x, y);
                else
                    outside = std::max(outside, double(image.at(x, y).a));
            }
        EXPECT_LE(compare(cut, expected).maximum, toleranceOf(format));
        EXPECT_EQ(outside, 0.0);
        EXPECT_EQ(renderer.glError(), 0u);
    }
}

TEST_F(Viewers, SlaveCameras)
{
    TwinVolume twin = makeScene();
    const osg::ref_ptr<osg::GraphicsContext> context = makeContext();
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    viewer.setKeyEventSetsDone(0);
    viewer.setLightingMode(osg::View::NO_LIGHT);
    viewer.setSceneData(twin.node);
    const RenderOptions master = view();
    std::vector<Window> windows;
    const std::pair<osg::Matrixd, osg::Matrixd> offsets[] = {
        {osg::Matrixd::translate(0.4, 0.0, 0.0), osg::Matrixd()},
        {osg::Matrixd::translate(-0.4, 0.1, 0.0), osg::Matrixd::rotate(0.1, osg::Vec3d(0, 1, 0))}};
    for (const auto& offset : offsets) {
        windows.emplace_back(new osg::Camera, context.get());
        viewer.addSlave(windows.back().camera, offset.first, offset.second);
    }
    viewer.getCamera()->setViewMatrix(master.view);
    viewer.getCamera()->setProjectionMatrix(master.projection);
    viewer.getCamera()->setProjectionResizePolicy(osg::Camera::FIXED);
    viewer.realize();
    for (int frame = 0; frame < 2; ++frame) {
        for (const Window& window : windows)
            window.target->request(1);
        viewer.frame();
    }
    for (std::size_t i = 0; i < 2; ++i) {
        RenderOptions options = master;
        options.projection = master.projection * offsets[i].first;
        options.view = master.view * offsets[i].second;
        const FloatImage expected = support::renderScene(twin.node, options);
        const FloatImage image = windows[i].target->wait();
        EXPECT_GT(support::coveredPixels(expected, 0.2f).count(), 200u);
        EXPECT_LE(compare(image, expected).maximum, 1e-5);
        EXPECT_EQ(windows[i].target->glError(), 0u);
    }
}

class Threading : public support::GLTest,
                  public ::testing::WithParamInterface<osgViewer::ViewerBase::ThreadingModel>
{
};

TEST_P(Threading, CompositeViewerOfTwoContexts)
{
    // Three views of one scene: two in one context, one in another. Between frames the table
    // changes; what was drawn in each is compared with a viewer of its own.
    TwinVolume twin = makeScene();
    const osg::Vec3d eyes[] = {{40, -20, 30}, {-30, -10, 20}, {10, 45, 25}};
    const osg::ref_ptr<osg::GraphicsContext> contexts[] = {makeContext(), makeContext()};
    std::vector<Window> windows;
    osg::ref_ptr<osgViewer::CompositeViewer> viewer = new osgViewer::CompositeViewer;
    viewer->setThreadingModel(GetParam());
    viewer->setKeyEventSetsDone(0);
    for (int i = 0; i < 3; ++i) {
        osg::ref_ptr<osgViewer::View> v = new osgViewer::View;
        v->setLightingMode(osg::View::NO_LIGHT);
        windows.emplace_back(v->getCamera(), contexts[i / 2].get());
        windows.back().look(view(eyes[i]));
        v->setSceneData(twin.node);
        viewer->addView(v);
    }
    viewer->realize();
    const double opacities[] = {0.1, 0.02, 0.2};
    for (const double opacity : opacities) {
        ASSERT_TRUE(twin.node->getLookupTable()->setPoints(smoothPoints(opacity),
                                                           LookupTable::RANGE_FRACTION));
        for (const Window& window : windows)
            window.target->request(2);
        viewer->frame();
        viewer->frame();
        std::vector<FloatImage> images;
        for (const Window& window : windows)
            images.push_back(window.target->wait());
        viewer->stopThreading(); // the expected picture shares the scene
        for (int i = 0; i < 3; ++i) {
            const FloatImage expected = support::renderScene(twin.node, view(eyes[i]));
            const std::size_t view = static_cast<std::size_t>(i);
            EXPECT_GT(support::coveredPixels(expected, 0.05f).count(), 300u);
            EXPECT_LE(compare(images[view], expected).maximum, 1e-5) << i << " " << opacity;
            EXPECT_EQ(windows[view].target->glError(), 0u);
        }
        viewer->startThreading();
    }
    viewer->stopThreading();
}

TEST_P(Threading, ChangesWhileFramesAreDrawn)
{
    // Voxels, table, geometry and sampling change between frames that are still being drawn; the
    // last picture is that of the last state.
    TwinVolume twin = makeScene();
    RenderOptions options = view();
    options.threading = GetParam();
    support::SceneRenderer renderer(twin.node, options);
    osg::ref_ptr<Voxels> other =
        makeVoxels({25, 21, 17}, [](const glm::dvec3& p) { return 1.0 - bumps(p); });
    other->setBrickSize({13, 13, 13});
    const osg::ref_ptr<Voxels> original = twin.node->getVoxels();
    for (int i = 0; i < 12; ++i) {
        ASSERT_TRUE(twin.node->getLookupTable()->setPoints(smoothPoints(0.02 + 0.01 * i),
                                                           LookupTable::RANGE_FRACTION));
        twin.node->setVoxels(i % 3 == 0 ? other.get() : original.get());
        if (i % 4 == 1) original->dirty(i % 2);
        twin.setPeriod(0.5 + 0.1 * i);
        static_cast<VolumeGeometry*>(twin.node->getChild(0))
            ->setTetraSet(*VolumeGeometry::createBox(*original)->getTetraSet());
        renderer.viewer().frame();
    }
    const FloatImage image = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    renderer.viewer().stopThreading();
    EXPECT_LE(compare(image, support::renderScene(twin.node, view())).maximum, 1e-5);
    EXPECT_GT(support::coveredPixels(image, 0.2f).count(), 300u);
}

std::string modelName(const ::testing::TestParamInfo<osgViewer::ViewerBase::ThreadingModel>& info)
{
    switch (info.param) {
    case osgViewer::ViewerBase::SingleThreaded:
        return "SingleThreaded";
    case osgViewer::ViewerBase::CullDrawThreadPerContext:
        return "CullDrawThreadPerContext";
    case osgViewer::ViewerBase::DrawThreadPerContext:
        return "DrawThreadPerContext";
    default:
        return "CullThreadPerCameraDrawThreadPerContext";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Models, Threading,
    ::testing::Values(osgViewer::ViewerBase::SingleThreaded,
                      osgViewer::ViewerBase::CullDrawThreadPerContext,
                      osgViewer::ViewerBase::DrawThreadPerContext,
                      osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext),
    modelName);

} // namespace

} // namespace ViewersTest
