#include "StateScope.h"

namespace osgVolumizer {
namespace render {

namespace {

constexpr GLenum RASTERIZER_DISCARD = 0x8C89, SAMPLER_BINDING = 0x8919,
                 CONTEXT_PROFILE_MASK = 0x9126;
constexpr GLenum PROGRAM_IN_FORCE = 0x8B8D, PACK_BUFFER_BINDING = 0x88ED,
                 UNPACK_BUFFER_BINDING = 0x88EF;
constexpr GLint CORE_PROFILE = 1;

GLint integer(GLenum name)
{
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

void setMode(GLenum mode, GLboolean on)
{
    if (on)
        glEnable(mode);
    else
        glDisable(mode);
}

// What keeps fragments from a target, or changes them.
std::vector<GLenum> modesInTheWay(bool core)
{
    std::vector<GLenum> modes = {GL_BLEND,          GL_CULL_FACE,      GL_DEPTH_TEST,
                                 GL_STENCIL_TEST,   GL_SCISSOR_TEST,   GL_COLOR_LOGIC_OP,
                                 GL_POLYGON_SMOOTH, RASTERIZER_DISCARD};
    if (!core) modes.insert(modes.end(), {GL_ALPHA_TEST, GL_POLYGON_STIPPLE});
    for (GLenum plane = 0; plane < 6; ++plane)
        modes.push_back(GL_CLIP_PLANE0 + plane);
    return modes;
}

// How images lie in memory, besides their alignment.
constexpr GLenum PIXEL_STORES[] = {
    GL_PACK_ROW_LENGTH,  GL_PACK_SKIP_ROWS,     GL_PACK_SKIP_PIXELS,   GL_UNPACK_ROW_LENGTH,
    GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_IMAGE_HEIGHT};

} // namespace

StateScope::StateScope(osg::State& state)
    : _state(state), _gl(*state.get<osg::GLExtensions>()),
      _programObject(state.getLastAppliedProgramObject()),
      _core((integer(CONTEXT_PROFILE_MASK) & CORE_PROFILE) != 0)
{
    for (GLenum mode : modesInTheWay(_core)) {
        _modes.emplace_back(mode, glIsEnabled(mode));
        glDisable(mode);
    }
    for (GLenum name : PIXEL_STORES) {
        _pixelStores.emplace_back(name, integer(name));
        glPixelStorei(name, 0);
    }
    _program = integer(PROGRAM_IN_FORCE);
    glGetIntegerv(GL_VIEWPORT, _viewport);
    glGetIntegerv(GL_POLYGON_MODE, _polygonMode);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    saveBlending();
    saveBindings();
}

void StateScope::saveBlending()
{
    _equation[0] = integer(GL_BLEND_EQUATION_RGB);
    _equation[1] = integer(GL_BLEND_EQUATION_ALPHA);
    const GLenum names[] = {GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA,
                            GL_BLEND_DST_ALPHA};
    for (int i = 0; i < 4; ++i)
        _function[i] = integer(names[i]);
    glGetFloatv(GL_COLOR_CLEAR_VALUE, _clearColor);
    glGetBooleanv(GL_COLOR_WRITEMASK, _colorMask);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void StateScope::saveBindings()
{
    _drawFramebuffer = integer(GL_DRAW_FRAMEBUFFER_BINDING_EXT);
    _readFramebuffer = integer(GL_READ_FRAMEBUFFER_BINDING_EXT);
    _renderbuffer = integer(GL_RENDERBUFFER_BINDING_EXT);
    _packBuffer = integer(PACK_BUFFER_BINDING);
    _unpackBuffer = integer(UNPACK_BUFFER_BINDING);
    _gl.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, 0);
    _gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER_ARB, 0);
    _activeUnit = integer(GL_ACTIVE_TEXTURE);
    for (GLuint unit = 0; unit < 2; ++unit) {
        _gl.glActiveTexture(GL_TEXTURE0 + unit);
        _textures[unit] = integer(GL_TEXTURE_BINDING_3D);
        _samplers[unit] = integer(SAMPLER_BINDING);
        _gl.glBindSampler(unit, 0);
    }
}

StateScope::~StateScope()
{
    for (GLuint unit = 0; unit < 2; ++unit) {
        _gl.glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_3D, static_cast<GLuint>(_textures[unit]));
        _gl.glBindSampler(unit, static_cast<GLuint>(_samplers[unit]));
    }
    _gl.glActiveTexture(static_cast<GLenum>(_activeUnit));
    _gl.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, static_cast<GLuint>(_packBuffer));
    _gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER_ARB, static_cast<GLuint>(_unpackBuffer));
    _gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, static_cast<GLuint>(_renderbuffer));
    _gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, static_cast<GLuint>(_drawFramebuffer));
    _gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, static_cast<GLuint>(_readFramebuffer));
    _gl.glUseProgram(static_cast<GLuint>(_program));
    _state.setLastAppliedProgramObject(_programObject);
    glViewport(_viewport[0], _viewport[1], _viewport[2], _viewport[3]);
    if (_core) {
        glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(_polygonMode[0]));
    } else {
        glPolygonMode(GL_FRONT, static_cast<GLenum>(_polygonMode[0]));
        glPolygonMode(GL_BACK, static_cast<GLenum>(_polygonMode[1]));
    }
    _gl.glBlendEquationSeparate(static_cast<GLenum>(_equation[0]),
                                static_cast<GLenum>(_equation[1]));
    _gl.glBlendFuncSeparate(static_cast<GLenum>(_function[0]), static_cast<GLenum>(_function[1]),
                            static_cast<GLenum>(_function[2]), static_cast<GLenum>(_function[3]));
    glClearColor(_clearColor[0], _clearColor[1], _clearColor[2], _clearColor[3]);
    glColorMask(_colorMask[0], _colorMask[1], _colorMask[2], _colorMask[3]);
    for (const auto& store : _pixelStores)
        glPixelStorei(store.first, store.second);
    for (const auto& mode : _modes)
        setMode(mode.first, mode.second);
}

} // namespace render
} // namespace osgVolumizer
