#include "ShaderSource.h"

#include "Uniforms.h"

#include <cctype>
#include <sstream>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

bool isNamePart(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

// The names of a declaration's list "a, b[4];", of one with a value, or of a function.
std::vector<std::string> listedNames(const std::string& list)
{
    std::vector<std::string> names;
    std::string name;
    for (std::size_t i = 0; i <= list.size(); ++i) {
        const char c = i < list.size() ? list[i] : ';';
        if (isNamePart(c)) {
            name += c;
            continue;
        }
        if (c == '[') i = list.find(']', i);
        if (!name.empty() && c != ' ' && c != '[') {
            names.push_back(name);
            name.clear();
        }
        if (c == ';' || c == '=' || c == '(' || i == std::string::npos) break;
    }
    return names;
}

// Macros that rename the uniforms that code declares, each declaration in a line of its own.
std::string uniformDefines(const std::string& code)
{
    std::istringstream lines(code);
    std::string defines, line, word, type;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        if (!(words >> word >> type) || word != "uniform") continue;
        std::string list;
        std::getline(words, list);
        for (const std::string& name : listedNames(list))
            defines += "#define " + name + " " + uniformName(name) + "\n";
    }
    return defines;
}

} // namespace

std::set<std::string> namesIn(const std::string& code)
{
    static const std::set<std::string> qualifiers = {"const", "flat", "in", "out", "uniform"};
    static const std::set<std::string> types = {
        "void", "bool",           "int",    "float", "vec2",  "vec3",      "vec4",
        "mat3", "ivec2",          "ivec3",  "mat4",  "TEXEL", "sampler3D", "samplerBuffer",
        "uint", "usamplerBuffer", "struct", "Known", "Corner"};
    std::set<std::string> names;
    std::istringstream lines(code);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string word, rest;
        if (line.empty() || line[0] == ' ' || !(words >> word)) continue;
        if (word == "#define") {
            words >> word;
            names.insert(word.substr(0, word.find('(')));
            continue;
        }
        while (qualifiers.count(word) && words >> word)
            continue;
        std::getline(words, rest);
        if (!types.count(word)) continue;
        for (const std::string& name : listedNames(rest))
            names.insert(name);
    }
    return names;
}

std::string withSuffix(const std::string& code, const std::string& suffix,
                       const std::set<std::string>& names)
{
    std::string result, word;
    for (char c : code + '\n') {
        if (isNamePart(c)) {
            word += c;
            continue;
        }
        result += word + (names.count(word) ? suffix : "") + c;
        word.clear();
    }
    result.pop_back();
    return result;
}

std::string withSuffix(const std::string& code, const std::string& suffix)
{
    return withSuffix(code, suffix, namesIn(code));
}

osg::ref_ptr<osg::Shader> makeShader(osg::Shader::Type type, const std::string& header,
                                     const std::string& code)
{
    return new osg::Shader(type, header + uniformDefines(code) + code);
}

} // namespace render
} // namespace osgVolumizer
