#pragma once

#include <osg/Shader>

#include <string>

namespace osgVolumizer {
namespace render {

/// The text of a file by its path below shaders/, such as "rays/sum.glsl"; empty where there is
/// none. Generated when the library is built.
std::string shaderSource(const std::string& name);

/// A shader of a header (version, defines) and code whose uniforms are renamed: see uniformName().
osg::ref_ptr<osg::Shader> makeShader(osg::Shader::Type type, const std::string& header,
                                     const std::string& code);

} // namespace render
} // namespace osgVolumizer
