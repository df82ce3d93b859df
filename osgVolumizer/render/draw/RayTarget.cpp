#include "RayTarget.h"

#include "../context/ContextResources.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../context/ScreenPass.h"
#include "../context/Uniforms.h"
#include "RayBuffers.h"
#include "RayFunctions.h"
#include "VolumeProgram.h"

#include <osg/BlendEquation>
#include <osg/BlendFunc>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

constexpr unsigned UNIT_RAYS = UNIT_VOXELS;

void setEnabled(GLenum mode, GLboolean on)
{
    if (on)
        glEnable(mode);
    else
        glDisable(mode);
}

} // namespace

RayTarget::RayTarget(osg::State& state, ContextResources& resources,
                     const ProgramFeatures& features, const glm::ivec4& viewport)
    : _state(state), _gl(*state.get<osg::GLExtensions>()), _resources(resources),
      _features(features), _viewport(viewport),
      _program(state.getLastAppliedAttribute(osg::StateAttribute::PROGRAM)),
      _blend(glIsEnabled(GL_BLEND)), _depthTest(glIsEnabled(GL_DEPTH_TEST))
{
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING_EXT, &_drawFramebuffer);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING_EXT, &_readFramebuffer);
    glGetIntegerv(GL_BLEND_EQUATION_RGB, &_equation[0]);
    glGetIntegerv(GL_BLEND_EQUATION_ALPHA, &_equation[1]);
    const GLenum names[] = {GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA,
                            GL_BLEND_DST_ALPHA};
    for (int i = 0; i < 4; ++i)
        glGetIntegerv(names[i], &_function[i]);

    glGetBooleanv(GL_COLOR_WRITEMASK, _colorMask);
    _made =
        ensureRays(_state, _resources.part<RayBuffers>(), std::max(_viewport.x + _viewport.z, 1),
                   std::max(_viewport.y + _viewport.w, 1));
    if (!_made) {
        reportOnce({ErrorCode::NOT_SUPPORTED, "the card has no memory for gathered values; volumes "
                                              "with such ray functions are not drawn"});
        return;
    }
    _gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, _resources.part<RayBuffers>().framebuffer);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    const RayFunctionRow& row = rowOf(_features.rayFunction);
    GLfloat clearColor[4];
    glGetFloatv(GL_COLOR_CLEAR_VALUE, clearColor);
    const GLboolean scissor = glIsEnabled(GL_SCISSOR_TEST);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(row.emptyValue, row.emptyValue, row.emptyValue, row.emptyValue);
    glClear(GL_COLOR_BUFFER_BIT);
    glClearColor(clearColor[0], clearColor[1], clearColor[2], clearColor[3]);
    setEnabled(GL_SCISSOR_TEST, scissor);
    glEnable(GL_BLEND);
    _gl.glBlendEquation(row.blendEquation);
    glBlendFunc(GL_ONE, GL_ONE);
}

void RayTarget::resolve(const VolumeLook& look)
{
    _gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, static_cast<GLuint>(_drawFramebuffer));
    _gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, static_cast<GLuint>(_readFramebuffer));
    _gl.glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDisable(GL_DEPTH_TEST); // rays ended at the opaque scene already
    glColorMask(_colorMask[0], _colorMask[1], _colorMask[2], _colorMask[3]);
    osg::ref_ptr<osg::Program>& resolving =
        _resources.part<RayBuffers>().programs[{_features.rayFunction, _features.rgba}];
    if (!resolving) resolving = makeResolveProgram(_features.rayFunction, _features.rgba);
    _state.applyAttribute(resolving.get());
    const auto* program = _state.getLastAppliedProgramObject();
    if (!program) return;
    const Uniforms uniforms(_gl, *program);
    uniforms.set("rays", int(UNIT_RAYS));
    _state.applyTextureAttribute(UNIT_RAYS, _resources.part<RayBuffers>().color.get());
    if (!_features.rgba) {
        uniforms.set("lookupTable", int(UNIT_TABLE));
        uniforms.set("valueToEntry", look.valueToEntry);
        uniforms.set("lastEntry", static_cast<float>(look.table.count - 1));
        _state.applyTextureAttribute(UNIT_TABLE, look.table.texture.get());
    }
    drawScreen(_state, _resources, _viewport);
}

RayTarget::~RayTarget()
{
    _gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, static_cast<GLuint>(_drawFramebuffer));
    _gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, static_cast<GLuint>(_readFramebuffer));
    _gl.glBlendEquationSeparate(static_cast<GLenum>(_equation[0]),
                                static_cast<GLenum>(_equation[1]));
    _gl.glBlendFuncSeparate(static_cast<GLenum>(_function[0]), static_cast<GLenum>(_function[1]),
                            static_cast<GLenum>(_function[2]), static_cast<GLenum>(_function[3]));
    setEnabled(GL_BLEND, _blend);
    setEnabled(GL_DEPTH_TEST, _depthTest);
    glColorMask(_colorMask[0], _colorMask[1], _colorMask[2], _colorMask[3]);
    // The next leaf may share our state set, and then finds nothing to apply.
    if (_program) _state.applyAttribute(_program);
}

} // namespace render
} // namespace osgVolumizer
