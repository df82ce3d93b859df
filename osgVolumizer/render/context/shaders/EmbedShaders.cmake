cmake_minimum_required(VERSION 3.22)

# Writes every shader file into one C++ source: std::string osgVolumizer::render::shaderSource(name).
# A file's name is its path below the folder shaders/ that it lies in.
set(text "#include <string>\n\nnamespace osgVolumizer {\nnamespace render {\n\n")
string(APPEND text "std::string shaderSource(const std::string& name)\n{\n")
set(names "")
foreach(shader ${SHADERS})
  string(REGEX REPLACE "^.*/shaders/" "" name ${shader})
  if(name IN_LIST names)
    message(FATAL_ERROR "Two shader files are named ${name}.")
  endif()
  list(APPEND names ${name})
  file(READ ${shader} source)
  string(APPEND text "    if (name == \"${name}\") return R\"glsl(${source})glsl\";\n")
endforeach()
string(APPEND text "    return {};\n}\n\n} // namespace render\n} // namespace osgVolumizer\n")
file(WRITE ${OUTPUT} "${text}")
