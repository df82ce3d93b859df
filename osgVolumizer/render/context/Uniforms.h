#pragma once

#include <osg/GLExtensions>
#include <osg/Program>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Uniforms of volumes' programs have a prefix, so that none of the scene's is meant for them, or
/// has another type. Shader code is written without: see withUniformPrefix().
inline std::string uniformName(const std::string& name)
{
    return "osgVolumizer_" + name;
}

/// Sets uniforms of the program that OSG applied last, without going through state sets.
class Uniforms
{
public:
    /// \param suffix of all names: see memberName()
    Uniforms(osg::GLExtensions& gl, const osg::Program::PerContextProgram& program,
             const std::string& suffix = {})
        : _gl(gl), _program(program), _suffix(suffix)
    {
    }
    void set(const char* name, float v) const { _gl.glUniform1f(location(name), v); }
    void set(const char* name, int v) const { _gl.glUniform1i(location(name), v); }
    void set(const char* name, const glm::vec2& v) const
    {
        _gl.glUniform2fv(location(name), 1, glm::value_ptr(v));
    }
    void set(const char* name, const glm::vec3& v) const
    {
        _gl.glUniform3fv(location(name), 1, glm::value_ptr(v));
    }
    void set(const char* name, const glm::vec4& v) const
    {
        _gl.glUniform4fv(location(name), 1, glm::value_ptr(v));
    }
    void set(const char* name, const glm::dmat3& v) const
    {
        const glm::mat3 m(v);
        _gl.glUniformMatrix3fv(location(name), 1, GL_FALSE, glm::value_ptr(m));
    }
    void set(const char* name, const glm::dmat4& v) const
    {
        const glm::mat4 m(v);
        _gl.glUniformMatrix4fv(location(name), 1, GL_FALSE, glm::value_ptr(m));
    }
    /// Arrays; an empty one sets nothing.
    void set(const char* name, const std::vector<glm::vec4>& v) const
    {
        if (!v.empty())
            _gl.glUniform4fv(location(name), static_cast<GLsizei>(v.size()), glm::value_ptr(v[0]));
    }
    void set(const char* name, const std::vector<glm::vec3>& v) const
    {
        if (!v.empty())
            _gl.glUniform3fv(location(name), static_cast<GLsizei>(v.size()), glm::value_ptr(v[0]));
    }
    void set(const char* name, const std::vector<float>& v) const
    {
        if (!v.empty()) _gl.glUniform1fv(location(name), static_cast<GLsizei>(v.size()), v.data());
    }

private:
    GLint location(const char* name) const
    {
        return _program.getUniformLocation(osg::Uniform::getNameID(uniformName(name + _suffix)));
    }

    osg::GLExtensions& _gl;
    const osg::Program::PerContextProgram& _program;
    const std::string _suffix;
};

} // namespace render
} // namespace osgVolumizer
