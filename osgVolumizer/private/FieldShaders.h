#pragma once

#include <string>

namespace osgVolumizer {

/// A number for each different field shader (VolumeGeometry::setFieldShader()) of the process: 0
/// for the empty one, below 1024; -1 where there are too many. Thread safe.
int fieldShaderNumber(const std::string& glsl);
/// What a number stands for.
std::string fieldShader(int number);

} // namespace osgVolumizer
