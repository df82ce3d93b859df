#include "HandleLook.h"

#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/Program>

namespace osgVolumizer {

namespace {

constexpr int ON_TOP_BIN = 1000; // after the transparent bin, and what applications have
constexpr int CLIP_PLANES = 8;

constexpr auto FORCED = osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE;
constexpr auto FORCED_OFF = osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE;

const char* const HANDLE_VERTEX = "#version 120\n"
                                  "varying vec4 handleColor;\n"
                                  "void main() {\n"
                                  "    handleColor = gl_FrontMaterial.diffuse;\n"
                                  "    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;\n"
                                  "}\n";
const char* const HANDLE_FRAGMENT =
    "#version 120\n"
    "uniform float osgVolumizerHandleOpacity;\n"
    "varying vec4 handleColor;\n"
    "void main() {\n"
    "    gl_FragColor = vec4(handleColor.rgb, osgVolumizerHandleOpacity);\n"
    "}\n";

osg::ref_ptr<osg::Program> handleProgram()
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgVolumizer handles");
    program->addShader(new osg::Shader(osg::Shader::VERTEX, HANDLE_VERTEX));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, HANDLE_FRAGMENT));
    return program;
}

osg::ref_ptr<osg::StateSet> handleState(osg::Program* program, osg::Uniform* opacity)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttributeAndModes(program, FORCED);
    state->addUniform(opacity);
    state->setMode(GL_LIGHTING, FORCED_OFF);
    for (unsigned i = 0; i < CLIP_PLANES; ++i)
        state->setMode(GL_CLIP_PLANE0 + i, FORCED_OFF);
    return state;
}

} // namespace

HandleLook::HandleLook()
    : _opacity(new osg::Uniform("osgVolumizerHandleOpacity", static_cast<float>(_throughOpacity)))
{
    _opacity->setDataVariance(osg::Object::DYNAMIC);
    const osg::ref_ptr<osg::Program> program = handleProgram();
    _solid = handleState(program, new osg::Uniform("osgVolumizerHandleOpacity", 1.0f));
    _solid->setMode(GL_BLEND, FORCED_OFF);
    _through = handleState(program, _opacity);
    _through->setAttributeAndModes(
        new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA),
        FORCED);
    _through->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false), FORCED);
    _through->setMode(GL_DEPTH_TEST, FORCED_OFF);
    // Once a pixel: without the far sides of closed shapes. Tabs of boxes have their own way.
    _through->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
    _through->setRenderBinDetails(ON_TOP_BIN, "RenderBin");
    _through->setNestRenderBins(false);
}

void HandleLook::setThroughOpacity(double opacity)
{
    _throughOpacity = opacity;
    _opacity->set(static_cast<float>(opacity));
}

void HandleLook::resizeGLObjectBuffers(unsigned int maximum)
{
    for (const auto& state : {_solid, _through})
        state->resizeGLObjectBuffers(maximum);
}

void HandleLook::releaseGLObjects(osg::State* state) const
{
    for (const auto& set : {_solid, _through})
        set->releaseGLObjects(state);
}

std::vector<osg::StateSet*> HandleLook::passes() const
{
    if (_throughOpacity == 0.0) return {_solid.get()};
    return {_solid.get(), _through.get()};
}

} // namespace osgVolumizer
