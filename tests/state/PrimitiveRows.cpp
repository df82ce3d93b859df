// How primitives become fragments.

#include "StateRow.h"

#include <osg/Capability>
#include <osg/CullFace>
#include <osg/FrontFace>
#include <osg/LineStipple>
#include <osg/LineWidth>
#include <osg/PatchParameter>
#include <osg/Point>
#include <osg/PointSprite>
#include <osg/PolygonMode>
#include <osg/PolygonOffset>
#include <osg/PolygonStipple>
#include <osg/PrimitiveRestartIndex>
#include <osg/ShadeModel>
#include <osg/VertexAttribDivisor>

#ifndef GL_PROGRAM_POINT_SIZE
#define GL_PROGRAM_POINT_SIZE 0x8642
#endif
#ifndef GL_PRIMITIVE_RESTART
#define GL_PRIMITIVE_RESTART 0x8F9D
#endif
#ifndef GL_RASTERIZER_DISCARD
#define GL_RASTERIZER_DISCARD 0x8C89
#endif

namespace osgVolumizer {
namespace test {

namespace {

using osg::StateSet;

const char* const NO_FACES = "A volume is what is inside its geometry; it has no faces to see.";
const char* const NO_LINES = "A volume has neither lines nor points.";
const char* const OWN_ARRAYS = "A volume is drawn from vertices of its own.";

void setStipple(StateSet& set, unsigned value)
{
    GLubyte mask[128];
    for (int row = 0; row < 32; ++row)
        for (int byte = 0; byte < 4; ++byte)
            mask[4 * row + byte] = row & 2 ? 0xcc : 0x33;
    set.setAttributeAndModes(new osg::PolygonStipple(mask), value);
}

// The test's geometry faces the eye.
void setFrontFace(StateSet& set, unsigned value)
{
    set.setAttributeAndModes(new osg::FrontFace(osg::FrontFace::CLOCKWISE), value);
    set.setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK), value);
}

void setPointSprite(StateSet& set, unsigned value)
{
    set.setTextureAttributeAndModes(0, new osg::PointSprite, value);
}

void setDivisors(StateSet& set, unsigned value)
{
    for (unsigned i = 0; i < 5; ++i)
        set.setAttributeAndModes(new osg::VertexAttribDivisor(i, 1), value);
}

void setRestart(StateSet& set, unsigned value)
{
    set.setAttributeAndModes(new osg::PrimitiveRestartIndex(2), value);
    set.setMode(GL_PRIMITIVE_RESTART, value);
}

void setDisablei(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Disablei> blend = new osg::Disablei;
    blend->setCapability(GL_BLEND);
    blend->setIndex(0);
    set.setAttribute(blend, value);
}

void setEnablei(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Enablei> scissor = new osg::Enablei;
    scissor->setCapability(GL_BLEND);
    scissor->setIndex(0);
    set.setAttribute(scissor, value);
}

} // namespace

std::vector<StateRow> primitiveRows()
{
    using osg::PolygonMode;
    return {
        {"CullFace", with<osg::CullFace>(osg::CullFace::FRONT), Effect::NONE, true, NO_FACES},
        {"FrontFace", setFrontFace, Effect::NONE, true, NO_FACES},
        {"PolygonMode", with<PolygonMode>(PolygonMode::FRONT_AND_BACK, PolygonMode::LINE),
         Effect::AS_ON_GEOMETRY, true,
         "Of lines or points: the edges of the tetrahedra and of the bricks.", Target::ANY,
         Scope::ELSEWHERE},
        {"PolygonOffset: away", with<osg::PolygonOffset>(0.0f, 1e7f), Effect::NONE, true, NO_FACES},
        {"PolygonOffset: towards the eye", with<osg::PolygonOffset>(0.0f, -1e7f), Effect::NONE,
         true, std::string(NO_FACES) + " Surfaces in a volume lie where the offset puts them.",
         Target::ANY, Scope::VOLUMES},
        {"PolygonStipple", setStipple, Effect::AS_ON_GEOMETRY, true,
         "Drawn where the pattern has ones."},
        {"`GL_POLYGON_SMOOTH`", mode(GL_POLYGON_SMOOTH), Effect::NONE, false, NO_FACES, Target::ANY,
         Scope::VOLUMES, true},
        {"ShadeModel", with<osg::ShadeModel>(osg::ShadeModel::FLAT), Effect::NONE, false, NO_FACES},
        {"LineWidth", with<osg::LineWidth>(3.0f), Effect::NONE, false, NO_LINES},
        {"LineStipple", with<osg::LineStipple>(2, GLushort(0x3333)), Effect::NONE, false, NO_LINES},
        {"`GL_LINE_SMOOTH`", mode(GL_LINE_SMOOTH), Effect::NONE, false, NO_LINES},
        {"Point", with<osg::Point>(5.0f), Effect::NONE, false, NO_LINES},
        {"PointSprite", setPointSprite, Effect::NONE, false, NO_LINES},
        {"`GL_PROGRAM_POINT_SIZE`", mode(GL_PROGRAM_POINT_SIZE), Effect::NONE, false, NO_LINES},
        {"PatchParameter", with<osg::PatchParameter>(4), Effect::NONE, false, OWN_ARRAYS},
        {"PrimitiveRestartIndex, `GL_PRIMITIVE_RESTART`", setRestart, Effect::NONE, true,
         OWN_ARRAYS},
        {"VertexAttribDivisor", setDivisors, Effect::NONE, false, OWN_ARRAYS},
        {"`GL_RASTERIZER_DISCARD`", mode(GL_RASTERIZER_DISCARD), Effect::AS_ON_GEOMETRY, true,
         "Nothing is drawn."},
        {"Capabilityi: Enablei", setEnablei, Effect::NONE, false, "Blending is on anyway."},
        {"Capabilityi: Disablei", setDisablei, Effect::NONE, true,
         "Samples along a ray are composited by the ray function.", Target::ANY, Scope::VOLUMES},
    };
}

} // namespace test
} // namespace osgVolumizer
