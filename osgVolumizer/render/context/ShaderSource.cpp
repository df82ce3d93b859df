#include "ShaderSource.h"

#include "Uniforms.h"

#include <cctype>
#include <sstream>

namespace osgVolumizer {
namespace render {

namespace {

// The names of a declaration's list "a, b[4], c".
std::string definesOf(const std::string& list)
{
    std::string defines, name;
    for (std::size_t i = 0; i <= list.size(); ++i) {
        const char c = i < list.size() ? list[i] : ',';
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
            name += c;
        } else if (c == '[') {
            i = list.find(']', i);
        } else if (c == ',') {
            defines += "#define " + name + " " + uniformName(name) + "\n";
            name.clear();
        }
    }
    return defines;
}

// Macros that rename the uniforms that code declares, each declaration in a line of its own.
std::string uniformDefines(const std::string& code)
{
    std::istringstream lines(code);
    std::string defines, line, word, type;
    while (std::getline(lines, line)) {
        std::istringstream words(line.substr(0, line.find(';')));
        if (!(words >> word >> type) || word != "uniform") continue;
        std::string list;
        std::getline(words, list);
        defines += definesOf(list);
    }
    return defines;
}

} // namespace

osg::ref_ptr<osg::Shader> makeShader(osg::Shader::Type type, const std::string& header,
                                     const std::string& code)
{
    return new osg::Shader(type, header + uniformDefines(code) + code);
}

} // namespace render
} // namespace osgVolumizer
