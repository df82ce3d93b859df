// What becomes of fragments: tests, masks, blending.

#include "StateRow.h"

#include <osg/AlphaFunc>
#include <osg/BlendColor>
#include <osg/BlendEquation>
#include <osg/BlendEquationi>
#include <osg/BlendFunc>
#include <osg/BlendFunci>
#include <osg/ColorMask>
#include <osg/ColorMaski>
#include <osg/Depth>
#include <osg/DepthRangeIndexed>
#include <osg/LogicOp>
#include <osg/Scissor>
#include <osg/ScissorIndexed>
#include <osg/Stencil>
#include <osg/StencilTwoSided>

namespace osgVolumizer {
namespace test {

namespace {

using osg::StateAttribute;
using osg::StateSet;

const char* const OWN_BLENDING = "Samples along a ray are composited by the ray function.";

void setStencilTest(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Stencil> stencil = new osg::Stencil;
    stencil->setFunction(osg::Stencil::EQUAL, 1, ~0u);
    set.setAttributeAndModes(stencil, value);
}

void setStencilWrites(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Stencil> stencil = new osg::Stencil;
    stencil->setFunction(osg::Stencil::ALWAYS, 1, ~0u);
    stencil->setOperation(osg::Stencil::KEEP, osg::Stencil::KEEP, osg::Stencil::REPLACE);
    set.setAttributeAndModes(stencil, value);
}

void setStencilTwoSided(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::StencilTwoSided> stencil = new osg::StencilTwoSided;
    for (const auto face : {osg::StencilTwoSided::FRONT, osg::StencilTwoSided::BACK})
        stencil->setFunction(face, osg::StencilTwoSided::EQUAL, 1, ~0u);
    set.setAttributeAndModes(stencil, value);
}

void setBlendColor(StateSet& set, unsigned value)
{
    set.setAttributeAndModes(new osg::BlendColor(osg::Vec4(0.2f, 0.2f, 0.2f, 0.2f)), value);
    set.setAttributeAndModes(
        new osg::BlendFunc(osg::BlendFunc::CONSTANT_ALPHA, osg::BlendFunc::ONE), value);
}

} // namespace

std::vector<StateRow> fragmentRows()
{
    using osg::Depth;
    const double n = 0.0, f = 0.1;
    return {
        {"AlphaFunc", with<osg::AlphaFunc>(osg::AlphaFunc::GREATER, 0.9f), Effect::NONE, true,
         "A volume is drawn in parts, each with a part of its opacity: a test of each means "
         "nothing. Use the lookup table."},
        {"BlendFunc", with<osg::BlendFunc>(GLenum(GL_SRC_ALPHA), GLenum(GL_ONE)), Effect::NONE,
         true, OWN_BLENDING},
        {"BlendFunci", with<osg::BlendFunci>(0u, GLenum(GL_SRC_ALPHA), GLenum(GL_ONE)),
         Effect::NONE, true, OWN_BLENDING},
        {"BlendEquation", with<osg::BlendEquation>(osg::BlendEquation::RGBA_MAX), Effect::NONE,
         true, std::string(OWN_BLENDING) + " For the largest value use MAXIMUM."},
        {"BlendEquationi", with<osg::BlendEquationi>(0u, osg::BlendEquation::RGBA_MAX),
         Effect::NONE, true, OWN_BLENDING},
        {"BlendColor", setBlendColor, Effect::NONE, true, OWN_BLENDING},
        {"`GL_BLEND` off", mode(GL_BLEND, false), Effect::NONE, true, OWN_BLENDING},
        {"ColorMask", with<osg::ColorMask>(true, false, true, false), Effect::AS_ON_GEOMETRY, true,
         "Only the channels of the mask are written."},
        {"ColorMaski", with<osg::ColorMaski>(0u, true, false, true, false), Effect::AS_ON_GEOMETRY,
         true, "The same, of colour attachment 0; a volume leaves the others alone."},
        {"LogicOp", with<osg::LogicOp>(osg::LogicOp::INVERT), Effect::NONE, true, OWN_BLENDING,
         Target::BYTE},
        {"`GL_DEPTH_TEST` off", mode(GL_DEPTH_TEST, false), Effect::AS_ON_GEOMETRY, true,
         "Drawn over opaque geometry in front and inside."},
        {"Depth: function ALWAYS", with<Depth>(Depth::ALWAYS, n, 1.0, false),
         Effect::AS_ON_GEOMETRY, true, "As with the test off."},
        {"Depth: function NEVER", with<Depth>(Depth::NEVER, n, 1.0, false), Effect::AS_ON_GEOMETRY,
         true, "Nothing is drawn."},
        {"Depth: functions GREATER, GEQUAL", with<Depth>(Depth::GREATER, n, 1.0, false),
         Effect::AS_ON_GEOMETRY, true,
         "Rays begin at opaque geometry: what is hidden otherwise is drawn."},
        {"Depth: function EQUAL", with<Depth>(Depth::EQUAL, n, 1.0, false), Effect::AS_ON_GEOMETRY,
         true, "Nothing is drawn."},
        {"Depth: function NOTEQUAL", with<Depth>(Depth::NOTEQUAL, n, 1.0, false),
         Effect::AS_ON_GEOMETRY, true, "As with the test off."},
        {"Depth: range", with<Depth>(Depth::LESS, n, f, false), Effect::AS_ON_GEOMETRY, true,
         "Rays end where their depth, mapped to the range, is that of opaque geometry."},
        {"DepthRangeIndexed",
         [](StateSet& set, unsigned value) {
             set.setAttributeAndModes(new osg::DepthRangeIndexed(0, 0.0, 0.1), value);
         },
         Effect::AS_ON_GEOMETRY, true, "The same, of viewport 0."},
        {"Depth: write mask", with<Depth>(Depth::LESS, n, 1.0, true), Effect::NONE, true,
         "A volume has no one depth, and leaves the depth buffer alone."},
        {"Stencil: test", setStencilTest, Effect::AS_ON_GEOMETRY, true,
         "Drawn where the test passes: mirrors, portals, caps."},
        {"Stencil: operations", setStencilWrites, Effect::AS_ON_GEOMETRY, true,
         "Where the volume is drawn. It covers a pixel any number of times: INCR and DECR count "
         "parts."},
        {"StencilTwoSided", setStencilTwoSided, Effect::AS_ON_GEOMETRY, true,
         "The test of front faces."},
        {"Scissor", with<osg::Scissor>(0, 20, 26, 20), Effect::AS_ON_GEOMETRY, true,
         "Drawn inside the rectangle."},
        {"ScissorIndexed",
         [](StateSet& set, unsigned value) {
             set.setAttributeAndModes(new osg::ScissorIndexed(0, 0.0f, 20.0f, 26.0f, 20.0f), value);
             set.setMode(GL_SCISSOR_TEST, value);
         },
         Effect::AS_ON_GEOMETRY, true, "The same, of viewport 0."},
    };
}

} // namespace test
} // namespace osgVolumizer
