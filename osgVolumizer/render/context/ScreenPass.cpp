#include "ScreenPass.h"

#include "ForeignState.h"
#include "ScissorScope.h"
#include "ShaderSource.h"
#include "SharedStateSets.h"
#include "Uniforms.h"

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/PolygonMode>
#include <osg/Program>

#include <array>

namespace osgVolumizer {
namespace render {

namespace {

// Whatever keeps the leaf beside from some of them.
void reachAllPixels(osg::StateSet& set)
{
    constexpr GLenum RASTERIZER_DISCARD = 0x8C89; // GL_RASTERIZER_DISCARD
    for (GLenum mode : {GLenum(GL_SCISSOR_TEST), GLenum(GL_POLYGON_STIPPLE),
                        GLenum(GL_POLYGON_SMOOTH), RASTERIZER_DISCARD})
        set.setMode(mode, FORCE_OFF);
}

} // namespace

osg::ref_ptr<osg::StateSet> screenState(const std::string& fragmentShader, bool writeDepth,
                                        const std::string& code)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgVolumizer " + fragmentShader);
    const std::string version = "#version 330\n";
    program->addShader(makeShader(osg::Shader::VERTEX, version, shaderSource("screen.vert.glsl")));
    program->addShader(
        makeShader(osg::Shader::FRAGMENT, version, code + shaderSource(fragmentShader)));
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    set->setAttributeAndModes(program, FORCE_ON);
    set->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, writeDepth), FORCE_ON);
    for (GLenum mode : {GL_BLEND, GL_CULL_FACE, GL_STENCIL_TEST, GL_ALPHA_TEST})
        set->setMode(mode, FORCE_OFF);
    reachAllPixels(*set);
    for (GLenum plane = 0; plane < 6; ++plane)
        set->setMode(GL_CLIP_PLANE0 + plane, FORCE_OFF);
    // Viewers show wire frames by a state above the scene.
    set->setAttribute(new osg::PolygonMode, FORCE_ON);
    const bool color = !writeDepth;
    set->setAttribute(new osg::ColorMask(color, color, color, color), FORCE_ON);
    return set;
}

// One triangle over the whole viewport.
void drawScreen(osg::State& state, ContextResources& resources, const glm::ivec4& area)
{
    static const std::array<float, 6> corners = {-1.0f, -1.0f, 3.0f, -1.0f, -1.0f, 3.0f};
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const ScissorScope scissor;
    if (!scissor.set(area)) return;
    const ForeignStateScope foreign(state, false);
    state.lazyDisablingOfVertexAttributes();
    state.applyDisablingOfVertexAttributes();
    resources.vertices.stream(gl, GL_ARRAY_BUFFER_ARB, corners.data(), sizeof(corners));
    gl.glEnableVertexAttribArray(0);
    gl.glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    gl.glDisableVertexAttribArray(0);
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
    state.unbindVertexBufferObject();
}

osg::ref_ptr<osg::StateSet> clearState()
{
    return sharedStateSet(SharedState::CLEAR, []() {
        osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
        set->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, true), FORCE_ON);
        set->setAttribute(new osg::Stencil, FORCE_ON); // its write mask is all ones
        reachAllPixels(*set);
        return set;
    });
}

void clearArea(const glm::ivec4& area, GLbitfield what)
{
    const ScissorScope scissor;
    glClearStencil(0);
    if (scissor.set(area)) glClear(what);
}

osg::ref_ptr<osg::Stencil> countingStencil(osg::Stencil::Function function, int reference)
{
    osg::ref_ptr<osg::Stencil> stencil = new osg::Stencil;
    stencil->setFunction(function, reference, 0xff);
    stencil->setOperation(osg::Stencil::INCR, osg::Stencil::INCR, osg::Stencil::INCR);
    return stencil;
}

void bindFramebuffer(osg::State& state, GLuint name)
{
    state.get<osg::GLExtensions>()->glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, name);
}

void setUniform(osg::State& state, const char* name, int value)
{
    if (const auto* program = state.getLastAppliedProgramObject())
        state.get<osg::GLExtensions>()->glUniform1i(
            program->getUniformLocation(osg::Uniform::getNameID(uniformName(name))), value);
}

} // namespace render
} // namespace osgVolumizer
