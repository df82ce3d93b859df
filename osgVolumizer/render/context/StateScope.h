#pragma once

#include <osg/GLExtensions>
#include <osg/State>

#include <vector>

namespace osgVolumizer {
namespace render {

/// Takes all that a scene may have set out of the way of a pass over a framebuffer object: it is
/// drawn to as it comes, nothing is tested, blended, masked, or shifted in memory. Puts it back in
/// the end, so that OSG's idea of the state stays true. In the draw thread; costs some dozen
/// queries, so not for every frame.
class StateScope
{
public:
    explicit StateScope(osg::State& state);
    ~StateScope();
    StateScope(const StateScope&) = delete;
    StateScope& operator=(const StateScope&) = delete;

private:
    void saveBlending();
    void saveBindings();

    osg::State& _state;
    osg::GLExtensions& _gl;
    const osg::Program::PerContextProgram* _programObject;
    std::vector<std::pair<GLenum, GLboolean>> _modes;
    std::vector<std::pair<GLenum, GLint>> _pixelStores;
    GLint _program = 0, _drawFramebuffer = 0, _readFramebuffer = 0, _renderbuffer = 0;
    GLint _activeUnit = 0, _textures[2] = {}, _samplers[2] = {};
    GLint _packBuffer = 0, _unpackBuffer = 0;
    GLint _viewport[4] = {}, _polygonMode[2] = {};
    GLint _equation[2] = {}, _function[4] = {};
    GLfloat _clearColor[4] = {};
    GLboolean _colorMask[4] = {GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE};
    bool _core = false; ///< the context has the core profile
};

} // namespace render
} // namespace osgVolumizer
