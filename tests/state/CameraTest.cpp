// What cameras have: framebuffers of all formats, viewports, buffers, render orders. In each,
// volumes look like geometry in the same place.

#include "Stage.h"

#include <support/Compare.h>
#include <support/GLTest.h>

#include <osg/ColorMask>
#include <osg/Geometry>
#include <osg/Scissor>
#include <osg/Texture2D>

namespace CameraTest {

#ifndef GL_FRAMEBUFFER_SRGB
#define GL_FRAMEBUFFER_SRGB 0x8DB9
#endif

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;

namespace {

class Cameras : public support::GLTest, public ::testing::WithParamInterface<Content>
{
protected:
    Cameras() : _stage(GetParam()) {}

    /// Both versions, as the stage is arranged.
    void expectSame(const std::string& what, double tolerance)
    {
        SCOPED_TRACE(what);
        const FramebufferContents geometry = _stage.geometry(nullptr, 0, true);
        const FramebufferContents volume = _stage.volume(nullptr, 0);
        ASSERT_FALSE(geometry.empty() || volume.empty());
        EXPECT_EQ(volume.glError, geometry.glError);
        const double error = difference(volume, geometry);
        EXPECT_LE(error, tolerance);
        if (error > tolerance) {
            support::savePicture(volume.colors[0], "camera_" + nameOf(GetParam()) + "_" + what);
            support::savePicture(geometry.colors[0],
                                 "camera_" + nameOf(GetParam()) + "_" + what + "_expected");
        }
    }
    bool isOffered(const FramebufferFormat& format)
    {
        _stage.setFormat(format);
        return !_stage.geometry(nullptr, 0, true).empty();
    }

    Stage _stage;
};

std::string nameOf(const FramebufferFormat& format)
{
    char text[80];
    std::snprintf(text, sizeof(text), "colour %x depth %x samples %d%s", format.colors[0],
                  format.depth, format.samples, format.textures ? " textures" : "");
    return text;
}

TEST_P(Cameras, DepthsStencilsAndSamples)
{
    int offered = 0;
    for (const GLenum depth :
         {GLenum(0), GLenum(GL_DEPTH_COMPONENT16), GLenum(GL_DEPTH_COMPONENT24),
          GLenum(GL_DEPTH_COMPONENT32), GLenum(GL_DEPTH_COMPONENT32F),
          GLenum(GL_DEPTH24_STENCIL8_EXT), GLenum(GL_DEPTH32F_STENCIL8)})
        for (const int samples : {0, 2, 4, 8})
            for (const GLenum color : {GLenum(GL_RGBA8), GLenum(GL_RGBA32F_ARB)}) {
                FramebufferFormat format;
                format.colors = {color};
                format.depth = depth;
                format.samples = samples;
                if (!isOffered(format)) continue;
                ++offered;
                expectSame(nameOf(format), color == GL_RGBA8 ? 2.6 / 255.0 : 2e-4);
            }
    EXPECT_GE(offered, 28); // 0 and 4 samples have to be
}

TEST_P(Cameras, Colours)
{
    const std::pair<GLenum, double> colors[] = {{GL_RGBA16F_ARB, 2e-3},    {GL_RGBA16, 3e-4},
                                                {GL_RGB10_A2, 0.34},       {GL_RGB8, 2.6 / 255.0},
                                                {GL_R11F_G11F_B10F, 3e-2}, {GL_RGBA32F_ARB, 2e-4}};
    int offered = 0;
    for (const bool textures : {false, true})
        for (const auto& color : colors) {
            FramebufferFormat format;
            format.colors = {color.first};
            format.textures = textures;
            if (!isOffered(format)) continue;
            ++offered;
            expectSame(nameOf(format), color.second);
        }
    EXPECT_GE(offered, 8);
}

TEST_P(Cameras, EncodedColours)
{
    FramebufferFormat format;
    format.colors = {GL_SRGB8_ALPHA8};
    ASSERT_TRUE(isOffered(format));
    for (const bool encode : {false, true}) {
        _stage.arrange({[encode](osg::Camera& camera) {
                            camera.getOrCreateStateSet()->setMode(GL_FRAMEBUFFER_SRGB, encode);
                        },
                        nullptr});
        // 8 bits in between round geometry once more, most where they are few.
        expectSame(encode ? "sRGB, encoded" : "sRGB, as it is", 4.6 / 255.0);
    }
}

// Others than the first one keep what they have, wherever surfaces are not; those may.
TEST_P(Cameras, SecondAttachment)
{
    for (const auto& colors : {std::vector<GLenum>{GL_RGBA32F_ARB, GL_RGBA32F_ARB},
                               std::vector<GLenum>{GL_RGBA8, GL_RGBA32F_ARB, GL_RGBA8}}) {
        FramebufferFormat format;
        format.colors = colors;
        ASSERT_TRUE(isOffered(format));
        expectSame(std::to_string(colors.size()) + " attachments", 2.6 / 255.0);
        const FramebufferContents bare = _stage.bare(), volume = _stage.volume(nullptr, 0);
        for (std::size_t i = 1; i < colors.size(); ++i) {
            std::size_t changed = 0;
            for (int y = 0; y < Stage::SIZE; ++y)
                for (int x = 0; x < Stage::SIZE; ++x) {
                    const bool surface = x >= 16 && x < 32 && y >= 18 && y < 34;
                    if (surface && GetParam() >= Content::SURFACE) continue;
                    changed += bare.colors[i].at(x, y) != volume.colors[i].at(x, y);
                }
            EXPECT_EQ(changed, 0u) << "attachment " << i << " of " << colors.size();
        }
    }
}

// What is drawn to is what volumes are drawn over.
TEST_P(Cameras, DrawBufferOfACamera)
{
    for (const GLenum color : {GLenum(GL_RGBA32F_ARB), GLenum(GL_RGBA8)}) {
        FramebufferFormat format;
        format.colors = {color, color};
        _stage.setFormat(format);
        _stage.restart(); // OSG sets it once a context
        _stage.arrange(
            {[](osg::Camera& camera) { camera.setDrawBuffer(GL_COLOR_ATTACHMENT1_EXT); }, nullptr});
        FramebufferContents geometry = _stage.geometry(nullptr, 0, true);
        FramebufferContents volume = _stage.volume(nullptr, 0);
        EXPECT_EQ(volume.glError, geometry.glError);
        std::swap(geometry.colors[0].pixels, geometry.colors[1].pixels);
        std::swap(volume.colors[0].pixels, volume.colors[1].pixels);
        EXPECT_GT(support::coveredPixels(geometry.colors[0]).count(), 1000u);
        EXPECT_LE(difference(volume, geometry), color == GL_RGBA8 ? 2.6 / 255.0 : 2e-4);
    }
}

TEST_P(Cameras, Viewports)
{
    FramebufferFormat byte;
    byte.colors = {GL_RGBA8};
    for (const auto& format : {FramebufferFormat(), byte}) {
        _stage.setFormat(format);
        const double tolerance = format.colors[0] == GL_RGBA8 ? 2.6 / 255.0 : 2e-4;
        const osg::Vec4i viewports[] = {{8, 6, 32, 34},   {20, 15, 48, 48}, {7, 9, 1, 1},
                                        {-10, 4, 48, 48}, {5, -12, 48, 48}, {-20, -17, 96, 96},
                                        {-60, 0, 48, 48}, {0, 0, 48, 48}};
        for (const osg::Vec4i& v : viewports) {
            _stage.arrange(
                {[v](osg::Camera& camera) { camera.setViewport(v.x(), v.y(), v.z(), v.w()); },
                 nullptr});
            expectSame("viewport " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
                           std::to_string(v.z()),
                       tolerance);
        }
    }
}

/// A camera of its own around a scene, with what the viewer's has.
osg::ref_ptr<osg::Camera> nested(osg::Node* scene, osg::Camera::RenderOrder order)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderOrder(order);
    camera->setReferenceFrame(osg::Transform::RELATIVE_RF);
    camera->setClearMask(GL_DEPTH_BUFFER_BIT);
    camera->addChild(scene);
    return camera;
}

// The scene in a texture, on a rectangle over the whole window.
osg::ref_ptr<osg::Node> throughTexture(osg::Node* scene)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(Stage::SIZE, Stage::SIZE);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    texture->setSourceFormat(GL_RGBA);
    texture->setSourceType(GL_FLOAT);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setResizeNonPowerOfTwoHint(false);
    const osg::ref_ptr<osg::Camera> camera = nested(scene, osg::Camera::PRE_RENDER);
    camera->setViewport(0, 0, Stage::SIZE, Stage::SIZE);
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::COLOR_BUFFER, texture);
    camera->attach(osg::Camera::PACKED_DEPTH_STENCIL_BUFFER, GL_DEPTH24_STENCIL8_EXT);
    camera->setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    const osg::ref_ptr<osg::Geometry> screen =
        osg::createTexturedQuadGeometry({-24, -24, 0}, {48, 0, 0}, {0, 48, 0});
    screen->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(camera);
    group->addChild(screen);
    return group;
}

TEST_P(Cameras, ArrangedInAnyWay)
{
    using osg::Camera;
    const auto camera = [](std::function<void(Camera&)> change) {
        return Stage::Arrangement{std::move(change), nullptr};
    };
    const auto order = [](Camera::RenderOrder when) {
        return Stage::Arrangement{nullptr, [when](osg::Node* scene) -> osg::ref_ptr<osg::Node> {
                                      return nested(scene, when);
                                  }};
    };
    const std::pair<const char*, Stage::Arrangement> arrangements[] = {
        {"scissor", camera([](Camera& c) {
             c.getOrCreateStateSet()->setAttributeAndModes(new osg::Scissor(14, 10, 15, 31));
         })},
        {"depth kept", camera([](Camera& c) { c.setClearMask(GL_COLOR_BUFFER_BIT); })},
        {"depth cleared to 0.6", camera([](Camera& c) { c.setClearDepth(0.6); })},
        {"depth cleared to 1", camera([](Camera& c) { c.setClearDepth(1.0); })},
        {"near and far computed", camera([](Camera& c) {
             c.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
         })},
        {"near and far of primitives", camera([](Camera& c) {
             c.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES);
         })},
        {"near plane in the volume", camera([](Camera& c) {
             c.setProjectionMatrix(osg::Matrixd::ortho(-24, 24, -24, 24, 60.0, 201.0));
         })},
        {"state inherited", camera([](Camera& c) {
             c.getOrCreateStateSet()->setAttribute(new osg::ColorMask(true, false, true, true));
         })},
        {"nested", order(Camera::NESTED_RENDER)},
        {"afterwards", order(Camera::POST_RENDER)},
        {"before", order(Camera::PRE_RENDER)},
        {"to a texture", {nullptr, throughTexture}},
    };
    FramebufferFormat byte;
    byte.colors = {GL_RGBA8};
    for (const auto& format : {FramebufferFormat(), byte})
        for (const auto& arrangement : arrangements) {
            _stage.setFormat(format);
            _stage.arrange(arrangement.second);
            expectSame(arrangement.first, format.colors[0] == GL_RGBA8 ? 2.6 / 255.0 : 2e-4);
        }
}

INSTANTIATE_TEST_SUITE_P(Draw, Cameras,
                         ::testing::Values(Content::SLABS, Content::SLICES, Content::MAXIMUM,
                                           Content::SURFACE, Content::OVERLAP),
                         [](const auto& tested) { return nameOf(tested.param); });

} // namespace

} // namespace CameraTest
