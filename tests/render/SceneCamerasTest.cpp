// Cameras that a scene has of its own: before, within and after the viewer's, to textures and to
// what stands for a window where there is none.

#include "Volumes.h"

#include <oracles/ClosedForms.h>
#include <support/GLTest.h>
#include <support/Shapes.h>

#include <osg/GLExtensions>
#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osg/observer_ptr>
#include <osgUtil/RenderStage>
#include <osgViewer/Renderer>
#include <osgViewer/Viewer>

#include <mutex>

namespace SceneCamerasTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;

namespace {

const glm::dvec4 VOLUME_COLOR(0.8, 0.4, 0.2, 0.05);

// Two pixels a unit; the volume is in the pixels from 32 to 64, each way.
RenderOptions viewOf(PictureTarget::Format format)
{
    RenderOptions options =
        RenderOptions().size(96, 96).orthographic(24.0).lookAt({8, -40, 8}, {8, 8, 8}, {0, 0, 1});
    options.format = format;
    return options;
}

// 16 units each way, of one colour.
osg::ref_ptr<VolumeAppearance> makeCube()
{
    return makeTwin(makeVoxels({17, 17, 17}, [](const glm::dvec3&) { return 0.5; }),
                    constantPoints(VOLUME_COLOR))
        .node;
}

// What 16 units of it look like over a colour.
glm::vec3 cubeOver(const glm::dvec3& behind)
{
    const glm::dvec4 c = oracle::constantSegment(VOLUME_COLOR, 16.0);
    return glm::vec3(glm::dvec3(c) + (1.0 - c.a) * behind);
}

osg::ref_ptr<osg::Texture2D> makeTexture(GLint format, GLenum source, GLenum type)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(32, 32);
    texture->setInternalFormat(format);
    texture->setSourceFormat(source);
    texture->setSourceType(type);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    return texture;
}

osg::ref_ptr<osg::Texture2D> makeColors()
{
    return makeTexture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
}

// A camera of 32 x 32 pixels, 32 units each way, in the middle of which a cube is.
osg::ref_ptr<osg::Camera> makePortrait(osg::Camera::RenderOrder order, osg::Texture* colors,
                                       osg::Camera::RenderTargetImplementation target,
                                       const osg::Vec4& background)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setRenderOrder(order);
    camera->setRenderTargetImplementation(target);
    camera->setViewport(0, 0, 32, 32);
    camera->setClearColor(background);
    camera->setProjectionMatrixAsOrtho(-16, 16, -16, 16, 1, 100);
    camera->setViewMatrixAsLookAt({8, -40, 8}, {8, 8, 8}, {0, 0, 1});
    if (colors) camera->attach(osg::Camera::COLOR_BUFFER, colors);
    camera->addChild(makeCube());
    return camera;
}

// A texture on a square of 12 units, whose lower left corner is at (x, z).
osg::ref_ptr<osg::Geometry> makeScreen(float x, float z, osg::Texture* texture)
{
    const osg::ref_ptr<osg::Geometry> screen =
        osg::createTexturedQuadGeometry({x, 8, z}, {12, 0, 0}, {0, 0, 12});
    screen->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
    return screen;
}

// A depth texture, as shadows have.
osg::ref_ptr<osg::Camera> makeDepthCamera()
{
    const osg::ref_ptr<osg::Camera> camera = makePortrait(
        osg::Camera::PRE_RENDER, nullptr, osg::Camera::FRAME_BUFFER_OBJECT, osg::Vec4());
    camera->attach(osg::Camera::DEPTH_BUFFER,
                   makeTexture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_FLOAT));
    camera->removeChildren(0, 1);
    camera->addChild(support::makeQuad({osg::Vec3(0, 0, 0), {9, 0, 0}, {9, 0, 9}, {0, 0, 9}},
                                       osg::Vec4(1, 1, 1, 1)));
    return camera;
}

// In pixels: a half transparent bar that reaches over the volume, and another volume.
osg::ref_ptr<osg::Camera> makeHud()
{
    osg::ref_ptr<osg::Camera> hud = new osg::Camera;
    hud->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    hud->setRenderOrder(osg::Camera::POST_RENDER, 1);
    hud->setClearMask(GL_DEPTH_BUFFER_BIT);
    hud->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    hud->setProjectionMatrixAsOrtho(0, 96, 0, 96, -100, 100);
    hud->addChild(
        support::makeQuad({osg::Vec3(8, 40, -50), {40, 40, -50}, {40, 56, -50}, {8, 56, -50}},
                          osg::Vec4(1, 1, 1, 0.5), true));
    osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrix::translate(40, 4, 0));
    place->addChild(makeCube());
    hud->addChild(place);
    return hud;
}

osg::ref_ptr<osg::Camera> makeNested()
{
    osg::ref_ptr<osg::Camera> nested = new osg::Camera;
    nested->setRenderOrder(osg::Camera::NESTED_RENDER);
    nested->addChild(support::makeQuad({osg::Vec3(18, 8, 0), {30, 8, 0}, {30, 8, 12}, {18, 8, 12}},
                                       osg::Vec4(0, 1, 0, 1)));
    return nested;
}

// All of them around a volume.
osg::ref_ptr<osg::Group> makeScene()
{
    using osg::Camera;
    const osg::ref_ptr<osg::Texture2D> drawn = makeColors(), copied = makeColors();
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(makePortrait(Camera::PRE_RENDER, drawn, Camera::FRAME_BUFFER_OBJECT,
                                 osg::Vec4(0, 0, 1, 1)));
    scene->addChild(
        makePortrait(Camera::PRE_RENDER, copied, Camera::FRAME_BUFFER, osg::Vec4(1, 1, 0, 1)));
    scene->addChild(makeDepthCamera());
    scene->addChild(makeCube());
    scene->addChild(makeScreen(-14, 18, drawn));
    scene->addChild(makeScreen(18, 18, copied));
    scene->addChild(makeNested());
    // What is drawn before the HUD goes elsewhere, the HUD to the window.
    scene->addChild(makePortrait(Camera::POST_RENDER, makeColors(), Camera::FRAME_BUFFER_OBJECT,
                                 osg::Vec4(1, 0, 0, 1)));
    scene->addChild(makeHud());
    return scene;
}

/// Listens to all that GL says is an error, once the viewer is realized.
class Listener : public osg::Operation
{
public:
    Listener() : osg::Operation("Listener", false) {}
    void operator()(osg::Object*) override
    {
        using Hear =
            void(GL_APIENTRY*)(GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*, const void*);
        const auto listen = reinterpret_cast<void(GL_APIENTRY*)(Hear, const void*)>(
            osg::getGLExtensionFuncPtr("glDebugMessageCallback"));
        ASSERT_NE(listen, nullptr);
        glEnable(0x92E0); // GL_DEBUG_OUTPUT
        glEnable(0x8242); // GL_DEBUG_OUTPUT_SYNCHRONOUS
        listen(&Listener::hear, this);
    }
    std::string errors() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _errors;
    }

private:
    static void GL_APIENTRY hear(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* text,
                                 const void* listener)
    {
        if (type != 0x824C) return; // GL_DEBUG_TYPE_ERROR
        auto* self = static_cast<Listener*>(const_cast<void*>(listener));
        const std::lock_guard<std::mutex> lock(self->_mutex);
        self->_errors += std::string(text) + "\n";
    }

    mutable std::mutex _mutex;
    std::string _errors;
};

void expectEachCamera(const FloatImage& image, float tolerance)
{
    const struct
    {
        const char* what;
        int x, y;
        glm::vec3 color;
    } places[] = {
        {"nothing", 2, 2, glm::vec3(0.0f)},
        {"the volume", 52, 36, cubeOver(glm::dvec3(0.0))},
        {"the texture drawn to, behind", 6, 70, glm::vec3(0, 0, 1)},
        {"the texture drawn to, its volume", 16, 80, cubeOver({0, 0, 1})},
        {"the texture copied, behind", 70, 70, glm::vec3(1, 1, 0)},
        {"the texture copied, its volume", 80, 80, cubeOver({1, 1, 0})},
        {"the nested camera", 80, 44, glm::vec3(0, 1, 0)},
        {"the HUD", 20, 48, glm::vec3(0.5f)},
        {"the HUD over the volume", 36, 48, 0.5f + 0.5f * cubeOver(glm::dvec3(0.0))},
        {"the HUD's volume", 48, 12, cubeOver(glm::dvec3(0.0))},
    };
    for (const auto& place : places)
        EXPECT_LE(glm::distance(glm::vec3(image.at(place.x, place.y)), place.color), tolerance)
            << place.what;
}

/// Looks at the leaf that is drawn last before the viewer's camera, and whether it is there then.
class WatchLastLeaf : public osg::Camera::DrawCallback
{
public:
    explicit WatchLastLeaf(const osg::Camera& viewers) : _viewers(viewers) {}
    /// Called when a camera of the scene is drawn, and before the viewer's.
    void operator()(osg::RenderInfo& info) const override
    {
        if (info.getCurrentCamera() == &_viewers) {
            existed = leaf.valid();
            return;
        }
        auto& renderer = dynamic_cast<const osgViewer::Renderer&>(*_viewers.getRenderer());
        auto* stage = const_cast<osgViewer::Renderer&>(renderer).getSceneView(0)->getRenderStage();
        for (const auto& before : stage->getPreRenderList())
            for (const auto& bin : before.second->getRenderBinList())
                if (!bin.second->getRenderLeafList().empty())
                    leaf = bin.second->getRenderLeafList().back();
        found = leaf.valid();
    }
    mutable osg::observer_ptr<osgUtil::RenderLeaf> leaf;
    mutable bool found = false, existed = false;

private:
    const osg::Camera& _viewers;
};

class SceneCameras : public support::GLTest, public ::testing::WithParamInterface<int>
{
};

class SceneCamerasAlone : public support::GLTest
{
};

TEST_P(SceneCameras, AreInThePictureWithoutErrors)
{
    for (const auto format : {PictureTarget::FLOAT32, PictureTarget::BYTE})
        for (const unsigned frames : {1u, 3u}) {
            SCOPED_TRACE(::testing::Message() << "format " << format << ", frames " << frames);
            const osg::ref_ptr<Listener> listener = new Listener;
            RenderOptions options = viewOf(format);
            options.frames = frames;
            options.threading = static_cast<osgViewer::ViewerBase::ThreadingModel>(GetParam());
            options.prepare = [&](osgViewer::Viewer& viewer) {
                viewer.setRealizeOperation(listener);
            };
            support::SceneRenderer renderer(makeScene(), options);
            const FloatImage image = renderer.render();
            ASSERT_FALSE(image.empty());
            support::savePicture(image, "scene_cameras_" + std::to_string(format));
            EXPECT_EQ(renderer.glError(), 0u);
            EXPECT_EQ(listener->errors(), "");
            expectEachCamera(image, 0.02f);
        }
}

// OSG hands the last leaf of a stage on to the next one, when the stage has no leaves any more.
TEST_F(SceneCamerasAlone, LastLeafIsThereForTheNextCamera)
{
    const osg::ref_ptr<osg::Camera> portrait =
        makePortrait(osg::Camera::PRE_RENDER, makeColors(), osg::Camera::FRAME_BUFFER_OBJECT,
                     osg::Vec4(0, 0, 1, 1));
    osg::ref_ptr<WatchLastLeaf> watch;
    RenderOptions options = viewOf(PictureTarget::FLOAT32);
    options.prepare = [&](osgViewer::Viewer& viewer) {
        watch = new WatchLastLeaf(*viewer.getCamera());
        portrait->setFinalDrawCallback(watch);
        viewer.getCamera()->setPreDrawCallback(watch);
    };
    EXPECT_FALSE(support::renderScene(portrait, options).empty());
    ASSERT_TRUE(watch && watch->found);
    EXPECT_TRUE(watch->existed);
}

INSTANTIATE_TEST_SUITE_P(Models, SceneCameras,
                         ::testing::Values(osgViewer::ViewerBase::SingleThreaded,
                                           osgViewer::ViewerBase::DrawThreadPerContext));

} // namespace

} // namespace SceneCamerasTest
