#include "TargetScope.h"

namespace osgVolumizer {
namespace render {

namespace {

void setEnabled(GLenum mode, GLboolean on)
{
    if (on)
        glEnable(mode);
    else
        glDisable(mode);
}

} // namespace

TargetScope::TargetScope(osg::State& state)
    : _state(state), _gl(*state.get<osg::GLExtensions>()),
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
}

void TargetScope::redirect(GLuint framebuffer) const
{
    _gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffer);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void TargetScope::drawOver() const
{
    _gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, static_cast<GLuint>(_drawFramebuffer));
    _gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, static_cast<GLuint>(_readFramebuffer));
    glEnable(GL_BLEND);
    _gl.glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDisable(GL_DEPTH_TEST); // rays ended at the opaque scene already
    glColorMask(_colorMask[0], _colorMask[1], _colorMask[2], _colorMask[3]);
}

void TargetScope::applyProgram() const
{
    if (_program) _state.applyAttribute(_program);
}

TargetScope::~TargetScope()
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
    applyProgram();
}

} // namespace render
} // namespace osgVolumizer
