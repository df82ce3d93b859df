// What is around a volume: the framebuffer it is drawn into, and what is drawn after it.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Shapes.h>

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Light>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osg/ShapeDrawable>
#include <osg/TexEnv>
#include <osg/Texture2D>

namespace FramebufferTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;

namespace {

RenderOptions view()
{
    return RenderOptions().size(80, 80).perspective(45.0).lookAt({40, -20, 30}, {12, 10, 8},
                                                                 {0, 0, 1});
}

class Framebuffer : public support::GLTest,
                    public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        osg::ref_ptr<Voxels> voxels = makeVoxels({25, 21, 17}, bumps);
        ASSERT_TRUE(voxels->setBrickSize({13, 13, 13}));
        _twin = makeTwin(voxels, smoothPoints(0.1), GetParam());
    }

    TwinVolume _twin;
};

TEST_P(Framebuffer, EightBitsAreAsGoodAsTheyCanBe)
{
    // Hundreds of layers, each far below what 8 bits can hold, over an opaque and a clear
    // background.
    _twin.setPeriod(0.1);
    for (const float alpha : {0.0f, 1.0f}) {
        RenderOptions options = view();
        options.background = osg::Vec4(0.3f * alpha, 0.5f * alpha, 0.2f * alpha, alpha);
        const FloatImage expected = support::renderScene(_twin.node, options);
        options.format = PictureTarget::BYTE;
        options.frames = 2;
        support::SceneRenderer renderer(_twin.node, options);
        const FloatImage image = renderer.render();
        support::savePicture(image, "framebuffer_byte");
        EXPECT_EQ(renderer.glError(), 0u);
        EXPECT_GT(support::coveredPixels(expected, 0.2f).count(), 800u);
        // Rounded once, when all is done; the background, rounded before, adds as much.
        EXPECT_LE(compare(image, expected).maximum, 1.0 / 255.0 + 1e-4);
    }
}

TEST_P(Framebuffer, EightBitsWithOpaqueGeometry)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(_twin.node);
    scene->addChild(support::makeQuad(
        {osg::Vec3(-5, 2, -5), {30, 8, 2}, {28, 14, 20}, {-4, 12, 18}}, {0.2f, 0.7f, 0.3f, 1.0f}));
    RenderOptions options = view();
    const FloatImage expected = support::renderScene(scene, options);
    options.format = PictureTarget::BYTE;
    const support::Difference d = compare(support::renderScene(scene, options), expected);
    EXPECT_LE(d.rmse, 2e-3);
    // Depth has 24 bits instead of a float's: the surface lies a little elsewhere.
    EXPECT_LE(d.maximum, 1.0 / 255.0 + 2e-3);
}

// Textured and lit geometry in front of the volume that is drawn after it, with most kinds of
// state.
osg::ref_ptr<osg::Group> fixedFunctionGeometry()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(8, 8, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 64; ++i)
        for (int c = 0; c < 4; ++c)
            image->data()[4 * i + c] =
                static_cast<unsigned char>(c == 3 ? 255 : 40 + (i * (37 + 11 * c)) % 200);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < 3; ++i) {
        osg::ref_ptr<osg::ShapeDrawable> shape = new osg::ShapeDrawable(
            new osg::Sphere(osg::Vec3(14.0f + 6.0f * i, 2.0f + 4.0f * i, 10.0f), 3.5f));
        shape->setColor(osg::Vec4(0.9f, 0.8f, 0.3f + 0.2f * i, 1.0f));
        shape->setUseDisplayList(i == 0);
        shape->setUseVertexBufferObjects(i == 1);
        osg::StateSet* state = shape->getOrCreateStateSet();
        for (unsigned unit = 0; unit <= unsigned(i); ++unit) {
            osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
            texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
            texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
            state->setTextureAttributeAndModes(unit, texture);
            state->setTextureAttribute(unit, new osg::TexEnv(osg::TexEnv::MODULATE));
        }
        osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.7f, 0.6f, 0.5f, 1.0f));
        material->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0.5f, 0.5f, 0.5f, 1.0f));
        material->setShininess(osg::Material::FRONT_AND_BACK, 20.0f);
        state->setAttributeAndModes(material);
        if (i == 2) state->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
        state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        group->addChild(shape);
    }
    group->getOrCreateStateSet()->setRenderBinDetails(20, "RenderBin");
    return group;
}

// The same with a program and vertex attributes of its own.
osg::ref_ptr<osg::Group> shadedGeometry()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<osg::Geometry> quad = support::makeQuad(
        {osg::Vec3(16, -8, 4), {26, -4, 4}, {26, -4, 14}, {16, -8, 14}}, {1, 1, 1, 1});
    osg::ref_ptr<osg::Vec4Array> extra = new osg::Vec4Array;
    for (int i = 0; i < 4; ++i)
        extra->push_back(osg::Vec4(0.2f * i, 0.9f - 0.2f * i, i % 2, 1.0f));
    quad->setVertexAttribArray(6, extra, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addBindAttribLocation("extra", 6);
    program->addShader(new osg::Shader(osg::Shader::VERTEX,
                                       "#version 120\nattribute vec4 extra; varying vec4 v;\n"
                                       "void main() { v = extra; gl_Position = ftransform(); }\n"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "#version 120\nvarying vec4 v; uniform float gain;\n"
                                       "void main() { gl_FragColor = gain * v; }\n"));
    osg::StateSet* state = quad->getOrCreateStateSet();
    state->setAttributeAndModes(program);
    state->addUniform(new osg::Uniform("gain", 0.8f));
    state->setRenderBinDetails(21, "RenderBin");
    group->addChild(quad);
    return group;
}

TEST_P(Framebuffer, WhatIsDrawnAfterwardsIsUnchanged)
{
    for (const auto format : {PictureTarget::FLOAT32, PictureTarget::BYTE}) {
        RenderOptions options = view();
        options.format = format;
        options.light = true;
        options.frames = 3;
        osg::ref_ptr<osg::Group> after = new osg::Group;
        after->addChild(fixedFunctionGeometry());
        after->addChild(shadedGeometry());
        // Where nothing but the geometry is seen, alone and after a volume.
        const FloatImage alone = support::renderScene(after, options);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(after);
        scene->addChild(_twin.node);
        support::SceneRenderer renderer(scene, options);
        const FloatImage image = renderer.render();
        support::savePicture(image, "framebuffer_after");
        EXPECT_EQ(renderer.glError(), 0u);
        std::size_t geometry = 0, changed = 0;
        for (std::size_t i = 0; i < alone.pixels.size(); ++i) {
            if (alone.pixels[i].a < 0.5f) continue;
            ++geometry;
            changed += alone.pixels[i] != image.pixels[i];
        }
        EXPECT_GT(geometry, 400u);
        EXPECT_EQ(changed, 0u);
        EXPECT_GT(support::coveredPixels(image, 0.2f).count(), geometry + 400);
    }
}

TEST_P(Framebuffer, StateAboveTheVolumeHarmsNothing)
{
    // State that scenes often have above everything, some of it protected or overriding.
    const FloatImage expected = support::renderScene(_twin.node, view());
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(_twin.node);
    osg::StateSet* state = scene->getOrCreateStateSet();
    const auto on = osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE;
    state->setMode(GL_LIGHTING, on);
    state->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK), on);
    state->setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.5f), on);
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(
        osg::Shader::FRAGMENT, "#version 120\nvoid main() { gl_FragColor = vec4(1.0); }\n"));
    state->setAttributeAndModes(program, on);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned unit = 0; unit < 4; ++unit)
        state->setTextureAttributeAndModes(unit, new osg::Texture2D(image), on);
    support::SceneRenderer renderer(scene, view());
    const FloatImage picture = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_LE(compare(picture, expected).maximum, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Techniques, Framebuffer,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

} // namespace

} // namespace FramebufferTest
