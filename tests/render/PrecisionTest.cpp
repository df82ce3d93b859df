// How exactly a context filters and blends is measured, once, and leaves nothing behind.

#include "Volumes.h"

#include <osgVolumizer/render/context/ContextResources.h>
#include <osgVolumizer/render/context/MeasurePrecision.h>

#include <support/Choices.h>
#include <support/GLTest.h>
#include <support/Precision.h>

#include <cmath>
#include <cstring>

namespace PrecisionTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using render::ContextLimits;
using render::ContextResources;
using render::Precision;
using support::RenderOptions;

namespace {

/// A context that is current, and hooks that change it.
class PrecisionOfAContext : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _here = support::precision(); // makes another context current
        _context = new support::SurfacelessGraphicsContext(8, 8);
        ASSERT_TRUE(_context->realize() && _context->makeCurrent());
        _hooks = &support::userObject<render::ContextHooks>(*_context);
    }
    void TearDown() override
    {
        if (_context) _context->close();
    }
    osg::State& state() { return *_context->getState(); }
    Precision measured() { return ContextResources(state()).limits.precision; }
    bool isLlvmpipe() const
    {
        return std::strstr(reinterpret_cast<const char*>(glGetString(GL_RENDERER)), "llvmpipe");
    }

    osg::ref_ptr<support::SurfacelessGraphicsContext> _context;
    render::ContextHooks* _hooks = nullptr;
    Precision _here;
};

// All that a measurement might change.
std::vector<double> stateOf(osg::State& state)
{
    std::vector<double> values;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const auto get = [&values](GLenum name) {
        GLdouble v[16] = {};
        glGetDoublev(name, v);
        values.insert(values.end(), v, v + 4);
    };
    for (GLenum mode : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST,
                        GL_ALPHA_TEST, GL_POLYGON_STIPPLE, GL_CLIP_PLANE0, GL_CLIP_PLANE0 + 5})
        values.push_back(glIsEnabled(mode));
    for (GLenum name :
         {GL_VIEWPORT, GL_SCISSOR_BOX, GL_POLYGON_MODE, GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB,
          GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA,
          GL_COLOR_CLEAR_VALUE, GL_COLOR_WRITEMASK, GL_PACK_ROW_LENGTH, GL_UNPACK_SKIP_PIXELS,
          GL_ACTIVE_TEXTURE, GL_DRAW_FRAMEBUFFER_BINDING_EXT, GL_READ_FRAMEBUFFER_BINDING_EXT,
          GL_RENDERBUFFER_BINDING_EXT, GL_CURRENT_PROGRAM, GL_PIXEL_PACK_BUFFER_BINDING_ARB})
        get(name);
    for (GLenum unit : {0u, 1u, 2u}) {
        gl.glActiveTexture(GL_TEXTURE0 + unit);
        get(GL_TEXTURE_BINDING_3D);
    }
    return values;
}

// Far from any default.
void disturb(osg::State& state)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    GLuint framebuffer = 0, textures[2] = {};
    gl.glGenFramebuffers(1, &framebuffer);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffer);
    glGenTextures(2, textures);
    for (GLuint unit : {0u, 1u}) {
        gl.glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_3D, textures[unit]);
    }
    gl.glActiveTexture(GL_TEXTURE2);
    for (GLenum mode : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST,
                        GL_ALPHA_TEST, GL_POLYGON_STIPPLE, GL_CLIP_PLANE0, GL_CLIP_PLANE0 + 5})
        glEnable(mode);
    glCullFace(GL_FRONT_AND_BACK);
    glDepthFunc(GL_NEVER);
    glStencilFunc(GL_NEVER, 1, 1);
    glAlphaFunc(GL_NEVER, 0.0f);
    glScissor(1, 2, 3, 4);
    glViewport(5, 6, 7, 8);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    gl.glBlendEquationSeparate(GL_MIN, GL_MAX);
    gl.glBlendFuncSeparate(GL_ZERO, GL_DST_COLOR, GL_DST_ALPHA, GL_SRC_ALPHA);
    glClearColor(0.1f, 0.2f, 0.3f, 0.4f);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
    glPixelStorei(GL_PACK_ROW_LENGTH, 300);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 5);
}

} // namespace

TEST_F(PrecisionOfAContext, IsMeasured)
{
    const Precision p = measured();
    EXPECT_TRUE(p.measured);
    // The least that there is to be expected of any card.
    EXPECT_LE(p.filterWeight, 1.0 / 256.0);
    EXPECT_LE(p.byteTexel, 0.75 / 255.0);
    EXPECT_LE(p.blend, 1e-3);
    EXPECT_EQ(measured().filterWeight, p.filterWeight);
    RecordProperty("filterWeight", std::to_string(p.filterWeight));
    if (!isLlvmpipe()) return;
    // Floats are filtered exactly, and bytes to bytes.
    _hooks->changeLimits = [](ContextLimits& limits) { limits.filterBits = 0; };
    const ContextLimits limits = ContextResources(state()).limits;
    EXPECT_LE(limits.precision.filterWeight, 1e-6);
    EXPECT_NEAR(limits.precision.byteTexel, 0.5 / 255.0, 0.02 / 255.0);
    EXPECT_LE(limits.precision.blend, 2e-7);
    EXPECT_TRUE(limits.filtersFloatsBest);
}

// Weights that are rounded to b bits are off by half of the last one.
TEST_F(PrecisionOfAContext, IsThatOfTheBitsEmulated)
{
    for (const int bits : {4, 6, 8}) {
        _hooks->changeLimits = [bits](ContextLimits& limits) { limits.filterBits = bits; };
        const Precision p = measured();
        EXPECT_TRUE(p.measured);
        const double expected = std::ldexp(1.0, -bits - 1);
        EXPECT_GE(p.filterWeight, expected - 1e-6) << bits;
        EXPECT_LE(p.filterWeight, expected + _here.filterWeight + 1e-6) << bits;
    }
}

TEST_F(PrecisionOfAContext, NeedsNothingOfTheStateAndLeavesItAsItWas)
{
    const Precision expected = measured();
    ContextResources resources(state());
    disturb(state());
    const std::vector<double> before = stateOf(state());
    const Precision p = render::measurePrecision(state(), resources);
    EXPECT_EQ(stateOf(state()), before);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    EXPECT_TRUE(p.measured);
    EXPECT_EQ(p.filterWeight, expected.filterWeight);
    EXPECT_EQ(p.byteTexel, expected.byteTexel);
    EXPECT_EQ(p.blend, expected.blend);
}

TEST_F(PrecisionOfAContext, IsTheWorstWhereItCannotBeMeasured)
{
    _hooks->changeLimits = [](ContextLimits& limits) { limits.floatTargets = false; };
    const ContextLimits limits = ContextResources(state()).limits;
    EXPECT_FALSE(limits.precision.measured);
    EXPECT_EQ(limits.precision.filterWeight, Precision().filterWeight);
    EXPECT_FALSE(limits.filtersFloatsBest);
}

// What filtering is off by shows in pictures, and no more than the bound of the tests says.
TEST_F(PrecisionOfAContext, BoundsWhatPicturesAreOffBy)
{
    constexpr int SIZE = 21;
    const Points points = {{0.0, {0.1, 0.8, 0.2, 0.02}}, {1.0, {1.0, 0.3, 0.1, 0.1}}};
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    volume->setLookupTable(makeTable(points));
    volume->setSamplingPeriod(osg::Vec3d(0.4, 0.4, 0.4));
    const RenderOptions options = RenderOptions().size(80, 80).perspective(40.0).lookAt(
        {45, -40, 35}, {10, 10, 10}, {0, 0, 1});
    volume->setExactFiltering(true);
    const support::FloatImage exact = support::renderScene(volume, options);
    volume->setExactFiltering(false);
    for (const int bits : {0, 4, 8}) {
        Precision p = _here;
        if (bits > 0) p.filterWeight = std::max(p.filterWeight, std::ldexp(1.0, -bits - 1));
        const auto image =
            support::renderScene(volume, support::limited(options, [bits](ContextLimits& limits) {
                                     if (bits > 0) limits.filterBits = bits;
                                 }));
        // Samples of bumps() differ by less than 0.14 from one to the next; no ray is longer than
        // the diagonal.
        const double bound = support::filteringBound(points, 0.14, std::sqrt(3.0) * (SIZE - 1), p);
        const double worst = support::compare(image, exact).maximum;
        EXPECT_LE(worst, bound + 1e-5) << bits;
        EXPECT_GE(worst, bits > 0 ? 1e-3 * bound : 0.0) << bits;
    }
}

// Weights of 4 bits would be off by far more. In the first frame nothing is known of the context.
TEST_F(PrecisionOfAContext, LetsAnErrorToleranceHaveExactFiltering)
{
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeVoxels(glm::ivec3(21), bumps));
    volume->setLookupTable(makeTable({{0.0, {0.1, 0.8, 0.2, 0.02}}, {1.0, {1.0, 0.3, 0.1, 0.1}}}));
    RenderOptions options = RenderOptions().size(80, 80).perspective(40.0).lookAt(
        {45, -40, 35}, {10, 10, 10}, {0, 0, 1});
    options = support::limited(options, [](ContextLimits& limits) { limits.filterBits = 4; });
    ASSERT_TRUE(volume->setErrorTolerance(1e-3));
    ASSERT_TRUE(support::waitForChoice(*volume));
    support::SceneRenderer renderer(volume, options);
    const support::FloatImage unknown = renderer.render(), known = renderer.render();
    volume->setExactFiltering(true);
    const support::FloatImage exact = renderer.render();
    EXPECT_LE(support::compare(unknown, exact).maximum, 2e-4);
    EXPECT_LE(support::compare(known, exact).maximum, 2e-4);
}

} // namespace PrecisionTest
