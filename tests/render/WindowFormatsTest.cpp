// Default framebuffers, as windows have them, of every format that the context offers.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Shapes.h>
#include <support/SurfacelessGraphicsContext.h>

#include <osgViewer/Viewer>

namespace WindowFormatsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using support::SurfaceFormat;

namespace {

RenderOptions view()
{
    return RenderOptions().size(96, 80).perspective(45.0).lookAt({40, -20, 30}, {12, 10, 8},
                                                                 {0, 0, 1});
}

// Reads a picture back when all is drawn; of several samples what a screen would show.
class ReadWindow : public osg::Camera::DrawCallback
{
public:
    void operator()(osg::RenderInfo&) const override
    {
        const GLenum e = glGetError();
        if (error == GL_NO_ERROR) error = e;
        image = FloatImage(view().width, view().height);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, view().width, view().height, GL_RGBA, GL_FLOAT, image.pixels.data());
    }
    mutable FloatImage image;
    mutable GLenum error = GL_NO_ERROR;
};

// The third frame, with nothing of the first ones' makeshift.
FloatImage showInWindow(osg::Node* scene, const SurfaceFormat& format, GLenum& error)
{
    const RenderOptions options = view();
    const osg::ref_ptr<support::SurfacelessGraphicsContext> context =
        new support::SurfacelessGraphicsContext(options.width, options.height, format);
    EXPECT_TRUE(context->status().ok()) << context->status().text;
    if (!context->valid()) return {};
    const osg::ref_ptr<ReadWindow> reader = new ReadWindow;
    osgViewer::Viewer viewer;
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(context);
    camera->setViewport(0, 0, options.width, options.height);
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    camera->setDrawBuffer(GL_FRONT);
    camera->setReadBuffer(GL_FRONT);
    camera->setViewMatrix(options.view);
    camera->setProjectionMatrix(options.projection);
    camera->setClearColor(options.background);
    camera->setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    camera->setFinalDrawCallback(reader);
    viewer.setLightingMode(osg::View::NO_LIGHT);
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setSceneData(scene);
    viewer.realize();
    for (int i = 0; i < 3; ++i)
        viewer.frame();
    error = reader->error;
    return reader->image;
}

osg::ref_ptr<osg::Group> scene(bool opaque, bool translucent)
{
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(makeTwin(makeVoxels({25, 21, 17}, bumps), smoothPoints(0.1)).node);
    if (opaque)
        group->addChild(support::makeQuad(
            {osg::Vec3(-5, 2, -5), {30, 8, 2}, {28, 14, 20}, {-4, 12, 18}}, {0.2f, 0.7f, 0.3f, 1}));
    if (translucent)
        group->addChild(
            support::makeQuad({osg::Vec3(-5, 15, -5), {30, 3, 0}, {28, 8, 20}, {-4, 18, 18}},
                              {0.8f, 0.3f, 0.1f, 0.5f}, true));
    return group;
}

// Pixels that are of one piece in the picture, and in those around it.
support::Mask awayFromEdges(const FloatImage& image)
{
    support::Mask mask = support::coveredPixels(image, -1.0f);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, image.height - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, image.width - 1); ++i)
                    if (glm::distance(image.at(i, j), image.at(x, y)) > 0.06f)
                        mask.set[std::size_t(y) * mask.width + x] = 0;
    return mask;
}

class WindowFormats : public support::GLTest
{
};

TEST_F(WindowFormats, ThereAreSome)
{
    const std::vector<SurfaceFormat> formats = support::OffscreenContext::surfaceFormats();
    const auto has = [&](auto property) {
        return std::any_of(formats.begin(), formats.end(), property);
    };
    EXPECT_TRUE(has([](const SurfaceFormat& f) { return f.samples == 4 && f.stencilBits == 0; }));
    EXPECT_TRUE(has([](const SurfaceFormat& f) { return f.samples == 4 && f.stencilBits == 8; }));
    EXPECT_TRUE(has([](const SurfaceFormat& f) { return f.samples == 0 && f.stencilBits == 0; }));
    EXPECT_TRUE(has([](const SurfaceFormat& f) { return f.depthBits == 0; }));
}

// A volume by itself, in and behind opaque geometry, with a translucent surface, with both.
TEST_F(WindowFormats, AllShowTheSamePicture)
{
    for (const SurfaceFormat& format : support::OffscreenContext::surfaceFormats())
        for (const bool opaque : {false, true})
            for (const bool translucent : {false, true}) {
                SCOPED_TRACE(::testing::Message()
                             << format.depthBits << " depth, " << format.stencilBits
                             << " stencil bits, " << format.samples << " samples"
                             << (opaque ? ", opaque" : "") << (translucent ? ", translucent" : ""));
                // Without a depth buffer nothing is hidden: no picture to compare with.
                if (opaque && format.depthBits == 0) continue;
                const FloatImage expected =
                    support::renderScene(scene(opaque, translucent), view());
                GLenum error = GL_NO_ERROR;
                const FloatImage image = showInWindow(scene(opaque, translucent), format, error);
                ASSERT_FALSE(image.empty());
                support::savePicture(image, "window_" + std::to_string(format.depthBits) + "_" +
                                                std::to_string(format.stencilBits) + "_" +
                                                std::to_string(format.samples));
                EXPECT_EQ(error, GLenum(GL_NO_ERROR));
                const support::Mask mask = awayFromEdges(expected);
                EXPECT_GT(mask.count(), 3000u);
                // 16 bits of depth place opaque geometry to a hundredth of a voxel.
                const double rounding = format.depthBits == 16 ? 1e-2 : 2e-3;
                EXPECT_LE(compare(image, expected, mask).maximum, 1.0 / 255.0 + rounding);
            }
}

TEST_F(WindowFormats, SeveralSamplesMakeSmoothEdges)
{
    // Of a green quad before a black background: some pixels are of neither.
    const auto mixedPixels = [](const FloatImage& image) {
        return std::count_if(image.pixels.begin(), image.pixels.end(), [](const glm::vec4& p) {
            return p.g > 0.02f && p.g < 0.65f && p.b < 0.45f * p.g + 0.01f &&
                   p.r < 0.3f * p.g + 0.01f;
        });
    };
    SurfaceFormat format;
    GLenum error = GL_NO_ERROR;
    format.samples = 4;
    const auto smooth = mixedPixels(showInWindow(scene(true, false), format, error));
    format.samples = 0;
    const auto jagged = mixedPixels(showInWindow(scene(true, false), format, error));
    EXPECT_GT(smooth, jagged + 40);
}

} // namespace

} // namespace WindowFormatsTest
