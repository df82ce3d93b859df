#include <support/GLTest.h>
#include <support/Shapes.h>

#include <osgViewer/CompositeViewer>

#include <cmath>
#include <thread>

namespace SceneRendererGLTest {

using namespace osgVolumizer::support;
using osgViewer::ViewerBase;

namespace {

// A rectangle in the plane y = 0, facing -y.
osg::ref_ptr<osg::Geometry> makeRectangle(float x0, float z0, float x1, float z1,
                                          const osg::Vec4& color)
{
    return makeQuad(
        {osg::Vec3(x0, 0, z0), osg::Vec3(x1, 0, z0), osg::Vec3(x1, 0, z1), osg::Vec3(x0, 0, z1)},
        color);
}

RenderOptions frontal(int size)
{
    return RenderOptions()
        .size(size, size)
        .orthographic(1.0)
        .lookAt(osg::Vec3d(0, -5, 0), osg::Vec3d(), osg::Vec3d(0, 0, 1));
}

class SceneRendererGLTest : public GLTest
{
};

class ThreadingGLTest : public GLTest, public testing::WithParamInterface<int>
{
};

} // namespace

TEST_F(SceneRendererGLTest, RowZeroIsTheBottomAndNothingIsRounded)
{
    const osg::Vec4 color(0.1f, 0.7f, 1e-6f, 0.3f);
    osg::ref_ptr<osg::Geometry> quad = makeRectangle(-1, -1, 0, -0.5, color);
    RenderOptions options = frontal(16);
    options.background = osg::Vec4(-3.5f, 1.7f, 1e-9f, 0.2f);
    const FloatImage image = renderScene(quad, options);
    ASSERT_EQ(image.pixels.size(), 256u);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const bool inside = x < 8 && y < 4;
            const osg::Vec4& c = inside ? color : options.background;
            const glm::vec4 expected(c.r(), c.g(), c.b(), c.a());
            EXPECT_EQ(image.at(x, y), expected) << x << " " << y;
        }
}

TEST_F(SceneRendererGLTest, DepthComesWithThePicture)
{
    RenderOptions options = frontal(8);
    options.computeNearFar = false;
    options.projection.makeOrtho(-1, 1, -1, 1, 1, 9);
    options.depth = true;
    for (const auto format : {PictureTarget::FLOAT32, PictureTarget::BYTE}) {
        options.format = format;
        const FloatImage image =
            renderScene(makeRectangle(-1, -1, 0, 1, osg::Vec4(1, 1, 1, 1)), options);
        ASSERT_EQ(image.depth.size(), 64u);
        EXPECT_NEAR(image.depth[image.index(1, 1)], 0.5, 1e-7);
        EXPECT_EQ(image.depth[image.index(6, 1)], 1.0f);
    }
}

TEST_F(SceneRendererGLTest, BytesAreRoundedAndClamped)
{
    RenderOptions options = frontal(4);
    options.format = PictureTarget::BYTE;
    const FloatImage image =
        renderScene(makeRectangle(-1, -1, 1, 1, osg::Vec4(0.31f, 2, 0, 1)), options);
    ASSERT_FALSE(image.empty());
    EXPECT_FLOAT_EQ(image.at(1, 1).r, std::round(0.31f * 255.0f) / 255.0f);
    EXPECT_EQ(image.at(1, 1).g, 1.0f);
}

TEST_P(ThreadingGLTest, EveryThreadingModelDrawsTheSamePicture)
{
    RenderOptions options = frontal(32);
    osg::ref_ptr<osg::Geometry> quad = makeRectangle(-0.5, -0.5, 0.5, 0.5, osg::Vec4(1, 0, 0, 1));
    const FloatImage single = renderScene(quad, options);
    options.threading = static_cast<ViewerBase::ThreadingModel>(GetParam());
    options.frames = 20;
    SceneRenderer renderer(quad, options);
    ASSERT_TRUE(renderer.status().ok()) << renderer.status().text;
    for (int repeat = 0; repeat < 3; ++repeat)
        EXPECT_EQ(renderer.render().pixels, single.pixels);
    EXPECT_EQ(renderer.glError(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Models, ThreadingGLTest,
                         testing::Values(ViewerBase::SingleThreaded,
                                         ViewerBase::CullDrawThreadPerContext,
                                         ViewerBase::DrawThreadPerContext,
                                         ViewerBase::CullThreadPerCameraDrawThreadPerContext));

TEST_P(ThreadingGLTest, CompositeViewersDrawInSeveralContexts)
{
    osg::ref_ptr<osg::Geometry> quad = makeRectangle(-0.5, -0.5, 0.5, 0.5, osg::Vec4(0, 1, 0, 1));
    const RenderOptions options = frontal(32);
    osg::ref_ptr<osgViewer::CompositeViewer> viewer = new osgViewer::CompositeViewer;
    viewer->setThreadingModel(static_cast<ViewerBase::ThreadingModel>(GetParam()));
    std::vector<osg::ref_ptr<PictureTarget>> targets;
    for (int i = 0; i < 2; ++i) {
        osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        view->setLightingMode(osg::View::NO_LIGHT);
        view->setSceneData(quad);
        osg::Camera* camera = view->getCamera();
        camera->setGraphicsContext(new SurfacelessGraphicsContext(32, 32));
        camera->setViewMatrix(options.view);
        camera->setProjectionMatrix(options.projection);
        camera->setClearColor(osg::Vec4());
        targets.emplace_back(new PictureTarget(*camera, 32, 32));
        targets.back()->request(10);
        viewer->addView(view);
    }
    viewer->realize();
    for (int frame = 0; frame < 10; ++frame)
        viewer->frame();
    const FloatImage single = renderScene(quad, options);
    for (const auto& target : targets)
        EXPECT_EQ(target->wait().pixels, single.pixels);
    viewer->stopThreading();
}

TEST_F(SceneRendererGLTest, CountersOfTheLastFrameAreFound)
{
    struct Count : osg::Drawable::DrawCallback
    {
        void drawImplementation(osg::RenderInfo& info, const osg::Drawable*) const override
        {
            const osg::Camera* camera = info.getCurrentCamera();
            osg::Stats* stats = camera ? const_cast<osg::Camera*>(camera)->getStats() : nullptr;
            const unsigned frame = info.getState()->getFrameStamp()->getFrameNumber();
            if (stats && stats->collectStats("osgVolumizer"))
                stats->setAttribute(frame, "osgVolumizer probe", 7.0);
        }
    };
    osg::ref_ptr<osg::Geometry> quad = makeRectangle(-1, -1, 1, 1, osg::Vec4(1, 1, 1, 1));
    quad->setDrawCallback(new Count);
    quad->setUseDisplayList(false);
    RenderOptions options = frontal(8);
    options.frames = 40; // more than the statistics remember
    SceneRenderer renderer(quad, options);
    ASSERT_FALSE(renderer.render().empty());
    EXPECT_EQ(renderer.milliseconds().size(), 40u);
    const std::map<std::string, double> expected{{"osgVolumizer probe", 7.0}};
    EXPECT_EQ(renderer.counters(), expected);
}

TEST_F(SceneRendererGLTest, FramingShowsTheWholeSphere)
{
    osg::ref_ptr<osg::Geometry> quad = makeRectangle(3, 4, 5, 6, osg::Vec4(1, 1, 1, 1));
    RenderOptions options = RenderOptions().size(64, 48).perspective(40.0);
    options.frameScene(quad->getBound());
    const FloatImage image = renderScene(quad, options);
    const Mask covered = coveredPixels(image);
    EXPECT_GT(covered.count(), 500u);
    for (int x = 0; x < 64; ++x) {
        EXPECT_FALSE(covered.set[image.index(x, 0)]);
        EXPECT_FALSE(covered.set[image.index(x, 47)]);
    }
}

TEST_F(SceneRendererGLTest, ContextIsCurrentInOneThreadAtATime)
{
    auto first = OffscreenContext::create();
    auto second = OffscreenContext::create(OffscreenContext::CORE);
    ASSERT_TRUE(first.ok() && second.ok());
    ASSERT_TRUE(first.value->makeCurrent());
    EXPECT_TRUE(first.value->isCurrent());
    ASSERT_TRUE(second.value->makeCurrent());
    EXPECT_FALSE(first.value->isCurrent());
    bool elsewhere = true;
    std::thread([&] { elsewhere = second.value->makeCurrent(); }).join();
    EXPECT_FALSE(elsewhere);
    EXPECT_TRUE(second.value->release());
}

} // namespace SceneRendererGLTest
