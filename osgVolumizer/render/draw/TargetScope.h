#pragma once

#include <osg/GLExtensions>
#include <osg/State>

namespace osgVolumizer {
namespace render {

/// Remembers what a drawable changes that draws to a buffer of its own before it draws to the
/// target, and puts it back in the end, so that OSG's idea of the state stays true. In the draw
/// thread.
class TargetScope
{
public:
    explicit TargetScope(osg::State& state);
    ~TargetScope();
    TargetScope(const TargetScope&) = delete;
    TargetScope& operator=(const TargetScope&) = delete;

    /// Draws to a framebuffer object, all channels of colour.
    void redirect(GLuint framebuffer) const;
    /// Draws to the target again, premultiplied colours over what is there, whatever its depth.
    void drawOver() const;
    /// The program that the drawable began with.
    void applyProgram() const;

private:
    osg::State& _state;
    osg::GLExtensions& _gl;
    const osg::StateAttribute* _program;
    GLint _drawFramebuffer = 0, _readFramebuffer = 0;
    GLint _equation[2] = {}, _function[4] = {};
    GLboolean _blend, _depthTest;
    GLboolean _colorMask[4] = {GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE};
};

} // namespace render
} // namespace osgVolumizer
