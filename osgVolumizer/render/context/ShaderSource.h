#pragma once

#include <osg/Shader>

#include <set>
#include <string>

namespace osgVolumizer {
namespace render {

/// The text of a file by its path below shaders/, such as "rays/sum.glsl"; empty where there is
/// none. Generated when the library is built.
std::string shaderSource(const std::string& name);

/// Code whose names at file scope (uniforms, functions, variables, macros) end with a suffix, so
/// that the same code can be in a shader several times. Expects a declaration to begin its line.
std::string withSuffix(const std::string& code, const std::string& suffix);
/// The same for code that uses names of other code.
std::string withSuffix(const std::string& code, const std::string& suffix,
                       const std::set<std::string>& names);
/// The names that code has at file scope.
std::set<std::string> namesIn(const std::string& code);

/// A shader of a header (version, defines) and code whose uniforms are renamed: see uniformName().
osg::ref_ptr<osg::Shader> makeShader(osg::Shader::Type type, const std::string& header,
                                     const std::string& code);

} // namespace render
} // namespace osgVolumizer
