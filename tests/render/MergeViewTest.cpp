// One mixed scene in every kind of view that OSG has: the same pixels wherever it is drawn.

#include "MixedScene.h"

#include <support/DebugOutput.h>
#include <support/GLTest.h>

#include <osgVolumizer/render/context/ContextResources.h>

#include <osg/FrameBufferObject>
#include <osgViewer/CompositeViewer>

namespace MergeViewTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;
using support::SurfacelessGraphicsContext;

namespace {

constexpr int SIZE = 33; // voxels per axis
const Points THIN = {{0.0, {0.1, 0.3, 0.9, 0.01}}, {1.0, {1.0, 0.4, 0.1, 0.1}}};

class MergeView : public support::GLTest
{
protected:
    MergeView()
    {
        _scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), THIN);
        _scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.5), THIN, osg::Matrixd::translate(20, 6, 9));
        _scene.addQuad({glm::vec3(-5, -3, 2), {37, 0, 6}, {40, 36, 30}, {-4, 30, 25}},
                       {0.1, 0.9, 0.2, 0.6});
    }
    static RenderOptions viewOf()
    {
        RenderOptions options;
        options.size(96, 64).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
        return options;
    }
    /// By itself, in a viewer of its own.
    FloatImage alone(const osg::Matrixd& view, const osg::Matrixd& projection) const
    {
        RenderOptions options = viewOf();
        options.view = view;
        options.projection = projection;
        return support::renderScene(_scene.root(), options);
    }
    static FloatImage pictureOf(osgViewer::ViewerBase& viewer, PictureTarget& target,
                                unsigned frames = 2)
    {
        target.request(frames);
        for (unsigned i = 0; i < frames; ++i)
            viewer.frame();
        return target.wait();
    }

    MixedScene _scene;
};

// Both eyes' matrices as OSG's viewer makes them.
struct Eye
{
    osg::Matrixd view, projection;
};

Eye eyeOf(const osg::DisplaySettings& settings, const RenderOptions& options, bool left)
{
    const double eyes = settings.getEyeSeparation(), screen = settings.getScreenDistance();
    const double fusion = screen, scale = fusion / screen;
    Eye eye;
    eye.projection = left ? settings.computeLeftEyeProjectionImplementation(options.projection)
                          : settings.computeRightEyeProjectionImplementation(options.projection);
    eye.view = left ? settings.computeLeftEyeViewImplementation(options.view, scale)
                    : settings.computeRightEyeViewImplementation(options.view, scale);
    EXPECT_GT(eyes, 0.0);
    return eye;
}

osg::ref_ptr<osg::DisplaySettings> stereoSettings(osg::DisplaySettings::StereoMode mode)
{
    osg::ref_ptr<osg::DisplaySettings> settings = new osg::DisplaySettings;
    settings->setStereo(true);
    settings->setStereoMode(mode);
    settings->setEyeSeparation(0.06f);
    settings->setScreenDistance(0.5f);
    settings->setScreenHeight(0.3f);
    settings->setScreenWidth(0.45f);
    settings->setSplitStereoAutoAdjustAspectRatio(false);
    return settings;
}

class Stereo : public MergeView,
               public ::testing::WithParamInterface<osg::DisplaySettings::StereoMode>
{
};

// Every mode of OSG that needs no special window. Compared with the same mode without volumes for
// where pixels come from, and with each eye's picture for what they are.
TEST_P(Stereo, EachEyeSeesItsPicture)
{
    const osg::ref_ptr<osg::DisplaySettings> settings = stereoSettings(GetParam());
    const RenderOptions options = viewOf();
    support::SceneRenderer renderer(_scene.root(), options);
    osg::Camera* camera = renderer.viewer().getCamera();
    camera->setDisplaySettings(settings);
    renderer.viewer().setFusionDistance(osgUtil::SceneView::USE_FUSION_DISTANCE_VALUE, 0.5f);
    const FloatImage picture = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    support::savePicture(picture, "merge_stereo_" + std::to_string(GetParam()));
    const Eye left = eyeOf(*settings, options, true), right = eyeOf(*settings, options, false);
    const FloatImage l = alone(left.view, left.projection), r = alone(right.view, right.projection);
    ASSERT_GT(support::compare(l, r).maximum, 0.1);
    const int w = options.width, h = options.height;
    double worst = 0.0;
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            const glm::vec4 p = picture.at(x, y);
            switch (GetParam()) {
            case osg::DisplaySettings::ANAGLYPHIC:
                worst = std::max({worst, double(std::abs(p.r - l.at(x, y).r)),
                                  double(std::abs(p.g - r.at(x, y).g)),
                                  double(std::abs(p.b - r.at(x, y).b))});
                break;
            case osg::DisplaySettings::LEFT_EYE:
                worst = std::max(worst, double(glm::length(p - l.at(x, y))));
                break;
            case osg::DisplaySettings::RIGHT_EYE:
                worst = std::max(worst, double(glm::length(p - r.at(x, y))));
                break;
            default:
                break;
            }
        }
    }
    EXPECT_LE(worst, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Modes, Stereo,
                         ::testing::Values(osg::DisplaySettings::LEFT_EYE,
                                           osg::DisplaySettings::RIGHT_EYE));

// Each half shows one eye, squeezed to half the window's size. Not run: OSG draws the left eye
// alone into a camera with a framebuffer object, and a window needs an X server.
TEST_F(MergeView, DISABLED_SplitStereoShowsBothEyes)
{
    for (const auto mode :
         {osg::DisplaySettings::HORIZONTAL_SPLIT, osg::DisplaySettings::VERTICAL_SPLIT}) {
        const bool sideBySide = mode == osg::DisplaySettings::HORIZONTAL_SPLIT;
        const osg::ref_ptr<osg::DisplaySettings> settings = stereoSettings(mode);
        settings->setSplitStereoHorizontalSeparation(0);
        settings->setSplitStereoVerticalSeparation(0);
        RenderOptions options = viewOf();
        support::SceneRenderer renderer(_scene.root(), options);
        renderer.viewer().getCamera()->setDisplaySettings(settings);
        renderer.viewer().setFusionDistance(osgUtil::SceneView::USE_FUSION_DISTANCE_VALUE, 0.5f);
        const FloatImage picture = renderer.render();
        EXPECT_EQ(renderer.glError(), 0u);
        support::savePicture(picture,
                             sideBySide ? "merge_stereo_horizontal" : "merge_stereo_vertical");
        const int w = options.width / (sideBySide ? 2 : 1),
                  h = options.height / (sideBySide ? 1 : 2);
        for (const bool left : {true, false}) {
            const Eye eye = eyeOf(*settings, options, left);
            RenderOptions half = options;
            half.width = w;
            half.height = h;
            half.view = eye.view;
            half.projection = eye.projection;
            const FloatImage expected = support::renderScene(_scene.root(), half);
            ASSERT_GT(support::coveredPixels(expected).count(), 200u);
            double worst = 0.0;
            const int x0 = sideBySide && !left ? w : 0, y0 = !sideBySide && left ? h : 0;
            for (int y = 0; y < h; ++y)
                for (int x = 0; x < w; ++x)
                    worst = std::max(
                        worst, double(glm::length(picture.at(x0 + x, y0 + y) - expected.at(x, y))));
            EXPECT_LE(worst, 2e-3) << sideBySide << left;
        }
    }
}

TEST_F(MergeView, SlaveCamerasSeeTheSame)
{
    const RenderOptions options = viewOf();
    support::SceneRenderer renderer(_scene.root(), options);
    osgViewer::Viewer& viewer = renderer.viewer();
    renderer.render();
    viewer.stopThreading();
    std::vector<osg::ref_ptr<PictureTarget>> targets;
    std::vector<osg::Matrixd> views;
    for (const double turn : {0.15, -0.2}) {
        osg::ref_ptr<osg::Camera> slave = new osg::Camera;
        slave->setGraphicsContext(viewer.getCamera()->getGraphicsContext());
        slave->setClearColor(osg::Vec4());
        slave->setProjectionResizePolicy(osg::Camera::FIXED);
        targets.push_back(new PictureTarget(*slave, options.width, options.height));
        views.push_back(osg::Matrixd::rotate(turn, osg::Vec3d(0, 1, 0)));
        viewer.addSlave(slave, osg::Matrixd(), views.back());
    }
    for (const auto& target : targets)
        target->request(2);
    renderer.render();
    renderer.render();
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const FloatImage picture = targets[i]->wait();
        const FloatImage expected = alone(options.view * views[i], options.projection);
        ASSERT_GT(support::coveredPixels(expected).count(), 200u);
        EXPECT_LE(support::compare(picture, expected).maximum, 1e-5) << i;
    }
}

TEST_F(MergeView, ViewsOfTwoContextsShareTheScene)
{
    const RenderOptions options = viewOf();
    for (const auto threading :
         {osgViewer::ViewerBase::SingleThreaded, osgViewer::ViewerBase::DrawThreadPerContext,
          osgViewer::ViewerBase::CullDrawThreadPerContext}) {
        osg::ref_ptr<osgViewer::CompositeViewer> viewer = new osgViewer::CompositeViewer;
        viewer->setThreadingModel(threading);
        viewer->setKeyEventSetsDone(0);
        std::vector<osg::ref_ptr<PictureTarget>> targets;
        std::vector<osg::Matrixd> views;
        for (const double turn : {0.0, 0.15}) {
            osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
            view->setSceneData(_scene.root());
            view->setLightingMode(osg::View::NO_LIGHT);
            osg::Camera* camera = view->getCamera();
            camera->setGraphicsContext(
                new SurfacelessGraphicsContext(options.width, options.height));
            camera->setProjectionResizePolicy(osg::Camera::FIXED);
            camera->setClearColor(osg::Vec4());
            views.push_back(options.view * osg::Matrixd::rotate(turn, osg::Vec3d(0, 1, 0)));
            camera->setViewMatrix(views.back());
            camera->setProjectionMatrix(options.projection);
            targets.push_back(new PictureTarget(*camera, options.width, options.height));
            viewer->addView(view);
        }
        viewer->realize();
        for (const auto& target : targets)
            target->request(3);
        for (int i = 0; i < 3; ++i)
            viewer->frame();
        for (std::size_t i = 0; i < targets.size(); ++i)
            EXPECT_LE(
                support::compare(targets[i]->wait(), alone(views[i], options.projection)).maximum,
                1e-5)
                << i << " " << threading;
        viewer->stopThreading();
    }
}

// A camera inside the graph, rendering to a texture before the main one: a mirror, a portal.
TEST_F(MergeView, NestedCameraSeesTheSame)
{
    const RenderOptions options = viewOf();
    osg::ref_ptr<osg::Camera> nested = new osg::Camera;
    nested->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    nested->setRenderOrder(osg::Camera::PRE_RENDER);
    nested->setClearColor(osg::Vec4());
    const osg::Matrixd mirrored = osg::Matrixd::scale(1, -1, 1) * options.view;
    nested->setViewMatrix(mirrored);
    nested->setProjectionMatrix(options.projection);
    const osg::ref_ptr<PictureTarget> target =
        new PictureTarget(*nested, options.width, options.height);
    nested->addChild(_scene.root());
    osg::ref_ptr<osg::Group> all = new osg::Group;
    all->addChild(nested);
    all->addChild(_scene.root());
    support::SceneRenderer renderer(all, options);
    target->request(2);
    renderer.render();
    const FloatImage outside = renderer.render();
    EXPECT_LE(support::compare(target->wait(), alone(mirrored, options.projection)).maximum, 1e-5);
    EXPECT_LE(support::compare(outside, alone(options.view, options.projection)).maximum, 1e-5);
}

// One viewer closed, another opened, in the same process, with and without a release in between.
TEST_F(MergeView, ContextsComeAndGo)
{
    const RenderOptions options = viewOf();
    const FloatImage first = alone(options.view, options.projection);
    for (int i = 0; i < 4; ++i) {
        RenderOptions other = options;
        other.width = 40 + 30 * i; // buffers grow and shrink
        support::SceneRenderer renderer(_scene.root(), options), second(_scene.root(), other);
        EXPECT_EQ(support::compare(renderer.render(), first).maximum, 0.0) << i;
        EXPECT_FALSE(second.render().empty());
        osg::State* state = renderer.viewer().getCamera()->getGraphicsContext()->getState();
        if (i % 2 == 0) {
            renderer.viewer().getCamera()->getGraphicsContext()->makeCurrent();
            _scene.root()->releaseGLObjects(state);
        } else {
            _scene.root()->releaseGLObjects(nullptr);
        }
        EXPECT_EQ(support::compare(renderer.render(), first).maximum, 0.0) << i;
        EXPECT_FALSE(second.render().empty());
        EXPECT_EQ(renderer.glError(), 0u);
        EXPECT_EQ(second.glError(), 0u);
    }
}

// The pictures that all others are compared with are right, and so is what each eye of a stereo
// pair sees, mirrored or not.
TEST_F(MergeView, AgreesWithTheOracle)
{
    const osg::ref_ptr<osg::DisplaySettings> settings =
        stereoSettings(osg::DisplaySettings::LEFT_EYE);
    for (const bool mirrored : {false, true}) {
        for (const bool left : {true, false}) {
            RenderOptions options = viewOf();
            const Eye eye = eyeOf(*settings, options, left);
            options.view = mirrored ? osg::Matrixd::scale(1, -1, 1) * eye.view : eye.view;
            options.projection = eye.projection;
            const Judged j = judge(_scene, options);
            save(j, std::string("merge_view") + (mirrored ? "_mirrored" : "") +
                        (left ? "_left" : "_right"));
            EXPECT_LE(j.all.rmse, 4e-3);
            EXPECT_LE(j.away.maximum, 4e-3);
            EXPECT_GT(j.away.pixels, 800u);
        }
    }
}

/// A framebuffer with several samples a pixel, or one, bound while a camera draws, and its picture.
struct SampledTarget : public osg::Camera::DrawCallback
{
    SampledTarget(const RenderOptions& options, GLsizei n, GLenum color = GL_RGBA32F_ARB,
                  GLenum depth = GL_DEPTH24_STENCIL8_EXT)
        : width(options.width), height(options.height), samples(n), colorFormat(color),
          depthFormat(depth), picture(width, height)
    {
    }
    void operator()(osg::RenderInfo& info) const override
    {
        osg::GLExtensions& gl = *info.getState()->get<osg::GLExtensions>();
        if (!framebuffers[0]) {
            gl.glGenFramebuffers(2, framebuffers);
            for (const int i : {1, 0}) {
                gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffers[i]);
                const GLsizei n = i == 0 ? samples : 0;
                for (const bool color : {true, false}) {
                    GLuint buffer = 0;
                    gl.glGenRenderbuffers(1, &buffer);
                    gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, buffer);
                    gl.glRenderbufferStorageMultisample(
                        GL_RENDERBUFFER_EXT, n, color ? colorFormat : depthFormat, width, height);
                    gl.glFramebufferRenderbuffer(
                        GL_FRAMEBUFFER_EXT, color ? GL_COLOR_ATTACHMENT0_EXT : depthAttachment(),
                        GL_RENDERBUFFER_EXT, buffer);
                }
                EXPECT_EQ(gl.glCheckFramebufferStatus(GL_FRAMEBUFFER_EXT),
                          GLenum(GL_FRAMEBUFFER_COMPLETE_EXT));
            }
        }
        drawing = !drawing;
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffers[0]);
        if (drawing) return;
        gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, framebuffers[1]);
        gl.glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                             GL_NEAREST);
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffers[1]);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, picture.pixels.data());
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT,
                             info.getState()->getGraphicsContext()->getDefaultFboId());
    }

    GLenum depthAttachment() const
    {
        const bool stencil =
            depthFormat == GL_DEPTH24_STENCIL8_EXT || depthFormat == GL_DEPTH32F_STENCIL8;
        return stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT_EXT;
    }

    const int width, height;
    const GLsizei samples;
    const GLenum colorFormat, depthFormat;
    mutable GLuint framebuffers[2] = {0, 0};
    mutable bool drawing = false;
    mutable FloatImage picture;
};

// A scene's picture in such a target. Nothing in drawing it may be an error, even one that somebody
// takes off.
FloatImage pictureIn(const SampledTarget& target, osg::Node* scene, const RenderOptions& options)
{
    osg::ref_ptr<osg::Camera> nested = new osg::Camera;
    nested->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    nested->setRenderOrder(osg::Camera::PRE_RENDER);
    nested->setViewport(0, 0, options.width, options.height);
    nested->setClearColor(osg::Vec4());
    nested->setViewMatrix(options.view);
    nested->setProjectionMatrix(options.projection);
    nested->setInitialDrawCallback(const_cast<SampledTarget*>(&target));
    nested->setFinalDrawCallback(const_cast<SampledTarget*>(&target));
    nested->addChild(scene);
    const osg::ref_ptr<support::DebugOutput> debug = new support::DebugOutput;
    support::SceneRenderer renderer(nested,
                                    support::prepared(options, [&debug](osgViewer::Viewer& viewer) {
                                        viewer.setRealizeOperation(debug);
                                    }));
    renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_TRUE(debug->messages().empty()) << debug->messages().front();
    return target.picture;
}

// Framebuffers with several samples a pixel: opaque edges stay smooth, the rest is as with one.
TEST_F(MergeView, SeveralSamplesAPixel)
{
    const RenderOptions options = viewOf();
    const auto pictureOf = [&options](osg::Node* scene, GLsizei samples) {
        const osg::ref_ptr<SampledTarget> target = new SampledTarget(options, samples);
        return pictureIn(*target, scene, options);
    };
    // Nothing opaque: as with one sample.
    const FloatImage translucent = alone(options.view, options.projection);
    EXPECT_LE(support::compare(pictureOf(_scene.root(), 0), translucent).maximum, 1e-5);
    EXPECT_LE(support::compare(pictureOf(_scene.root(), 4), translucent).maximum, 1e-5);
    // With something opaque in the middle.
    _scene.addMesh(sphereMesh({14, 10, 18}, 7.0, 48, 24), {0.9, 0.8, 0.1, 1.0}, true);
    const FloatImage one = pictureOf(_scene.root(), 0), four = pictureOf(_scene.root(), 4);
    support::savePicture(one, "merge_samples_one");
    support::savePicture(four, "merge_samples_four");
    // Silhouettes of the sphere differ, by what edges are smoothed. Near them depth at a sample's
    // place is not that of the pixel's centre; nothing else differs.
    const support::Mask away =
        support::coveredPixels(oracle::awayFromSilhouettes(_scene.truth(), cameraOf(options), 3.0));
    EXPECT_LE(support::compare(four, one, away).maximum, 4e-3);
    EXPECT_GT(support::compare(four, one).maximum, 0.02);
}

// Whatever they hold: the depths are copied to a buffer of the same format, since GL resolves
// samples of no other.
TEST_F(MergeView, SeveralSamplesOfEveryFormat)
{
    const RenderOptions options = viewOf();
    _scene.addMesh(sphereMesh({14, 10, 18}, 7.0, 48, 24), {0.9, 0.8, 0.1, 1.0}, true);
    const support::Mask away =
        support::coveredPixels(oracle::awayFromSilhouettes(_scene.truth(), cameraOf(options), 3.0));
    const FloatImage expected = alone(options.view, options.projection);
    for (const GLenum color : {GL_RGBA8, GL_RGBA16F_ARB, GL_RGBA32F_ARB})
        for (const GLenum depth :
             {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F,
              GL_DEPTH24_STENCIL8_EXT, GL_DEPTH32F_STENCIL8}) {
            const osg::ref_ptr<SampledTarget> target = new SampledTarget(options, 4, color, depth);
            const FloatImage image = pictureIn(*target, _scene.root(), options);
            const double rounding = color == GL_RGBA8 ? 1.0 / 255.0 : 1e-3;
            // 16 bits of depth are a few hundredths of a voxel here.
            EXPECT_LE(support::compare(image, expected, away).maximum, 4e-3 + rounding)
                << std::hex << color << " " << depth;
        }
}

// Closing a context frees what was made in it, wherever the scene has gone in the meantime.
TEST_F(MergeView, ClosingAContextFreesItsResources)
{
    const RenderOptions options = viewOf();
    const std::size_t before = render::contextResourcesCount();
    const FloatImage first = alone(options.view, options.projection);
    EXPECT_EQ(render::contextResourcesCount(), before);
    for (const bool detached : {false, true}) {
        support::SceneRenderer renderer(_scene.root(), options);
        EXPECT_EQ(support::compare(renderer.render(), first).maximum, 0.0) << detached;
        EXPECT_EQ(render::contextResourcesCount(), before + 1);
        if (detached) renderer.viewer().setSceneData(new osg::Group);
        renderer.viewer().getCamera()->getGraphicsContext()->close();
        EXPECT_EQ(render::contextResourcesCount(), before);
    }
}

} // namespace

} // namespace MergeViewTest
