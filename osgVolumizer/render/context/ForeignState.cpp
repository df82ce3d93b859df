#include "ForeignState.h"

#include "ProgramInterface.h"

#include <osg/Capability>
#include <osg/GLExtensions>

namespace osgVolumizer {
namespace render {

namespace {

using osg::StateAttribute;

constexpr GLenum CLAMP_FRAGMENT_COLOR = 0x891B; // GL_CLAMP_FRAGMENT_COLOR

void unbindSamplers(osg::State& state, osg::GLExtensions& gl)
{
    for (unsigned unit = 0; unit < UNIT_COUNT; ++unit) {
        if (!state.getLastAppliedTextureAttribute(unit, StateAttribute::SAMPLER)) continue;
        gl.glBindSampler(unit, 0);
        state.haveAppliedTextureAttribute(unit, StateAttribute::SAMPLER);
    }
}

void resetDivisors(osg::State& state, osg::GLExtensions& gl)
{
    for (unsigned i = 0; i < ATTRIBUTE_COUNT; ++i) {
        if (!state.getLastAppliedAttribute(StateAttribute::VERTEX_ATTRIB_DIVISOR, i)) continue;
        gl.glVertexAttribDivisor(i, 0);
        state.haveAppliedAttribute(StateAttribute::VERTEX_ATTRIB_DIVISOR, i);
    }
}

// Of the first draw buffer. Some drivers answer glIsEnabled() for all of them.
bool isBlendingOff(const osg::State& state)
{
    const auto type = StateAttribute::Type(StateAttribute::CAPABILITY + GL_BLEND);
    const StateAttribute* capability = state.getLastAppliedAttribute(type, 0);
    return dynamic_cast<const osg::Disablei*>(capability) || !glIsEnabled(GL_BLEND);
}

} // namespace

ForeignStateScope::ForeignStateScope(osg::State& state, bool blends)
    : _gl(*state.get<osg::GLExtensions>())
{
    if (_gl.glBindSampler) unbindSamplers(state, _gl);
    if (_gl.glVertexAttribDivisor) resetDivisors(state, _gl);
    if (_gl.glClampColor && state.getLastAppliedAttribute(StateAttribute::CLAMPCOLOR)) {
        _gl.glClampColor(CLAMP_FRAGMENT_COLOR, GL_FALSE);
        state.haveAppliedAttribute(StateAttribute::CLAMPCOLOR);
    }
    _blendWasOff = blends && _gl.glEnablei && isBlendingOff(state);
    if (_blendWasOff) _gl.glEnablei(GL_BLEND, 0);
}

ForeignStateScope::~ForeignStateScope()
{
    if (_blendWasOff) _gl.glDisablei(GL_BLEND, 0);
}

void reapplyInNextFrame(osg::State& state)
{
    constexpr unsigned MOST = 8; // of each kind
    for (const osg::StateSet* set : state.getStateSetStack())
        for (unsigned i = 0; i < MOST; ++i) {
            for (const StateAttribute::Type type :
                 {StateAttribute::CLIPPLANE, StateAttribute::LIGHT})
                if (set->getAttribute(type, i)) state.haveAppliedAttribute(type, i);
            if (set->getTextureAttribute(i, StateAttribute::TEXGEN))
                state.haveAppliedTextureAttribute(i, StateAttribute::TEXGEN);
        }
}

} // namespace render
} // namespace osgVolumizer
