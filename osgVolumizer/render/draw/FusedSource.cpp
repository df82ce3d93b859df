#include "FusedSource.h"

#include "../context/ShaderSource.h"
#include "Paint.h"

#include "../../private/FieldShaders.h"
#include "RayFunctions.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace osgVolumizer {
namespace render {

namespace {

// Features that a program has once, whatever is marched.
ProgramFeatures memberFeatures(ProgramFeatures features, bool inOrder)
{
    features.slab = inOrder;
    features.opaqueDepth = features.splitDepth = features.ranked = false;
    features.countSamples = features.coarse = false;
    features.slotCount = 0;
    return features;
}

// A line "#define NAME ..." undone.
std::string undefined(const std::string& defines)
{
    std::istringstream words(defines);
    std::string result, line, word;
    while (std::getline(words, line)) {
        std::istringstream(line.substr(line.find(' '))) >> word;
        result += "#undef " + word + "\n";
    }
    return result;
}

std::string memberCode(const ProgramFeatures& features, bool inOrder)
{
    const std::string code = volumeSource(features);
    const bool closedForm = inOrder && features.isExact();
    const std::string rays =
        closedForm ? "" : rayShaderSource(features.rayFunction) + shaderSource("cells.glsl");
    if (inOrder)
        return code + rays + shaderSource(features.tetrahedra ? "mesh.glsl" : "brick.glsl");
    return code + shaderSource("member.glsl") + rays;
}

// The names of a member's code, and what they end with.
struct Names
{
    std::set<std::string> names;
    std::string suffix;
};

// Code in which each line "#pragma each STATEMENT" is the statement for every member.
std::string forEach(const std::string& code, const std::vector<Names>& members)
{
    static const std::string each = "#pragma each ";
    std::istringstream lines(code);
    std::string result, line;
    while (std::getline(lines, line)) {
        if (line.compare(0, each.size(), each) != 0) {
            result += line + "\n";
            continue;
        }
        for (const Names& member : members)
            result +=
                "    " + withSuffix(line.substr(each.size()), member.suffix, member.names) + "\n";
    }
    return result;
}

} // namespace

std::string volumeSource(const ProgramFeatures& volume)
{
    std::string code;
    if (volume.tetrahedra) code += shaderSource("tetrahedra.glsl") + shaderSource("linear.glsl");
    if (volume.fieldCount > 0) code += fieldShader(volume.fieldShader) + "\n";
    for (const char* file :
         {"filtering.glsl", "voxels.glsl", "transfer.glsl", "ray.glsl", "shading.glsl", "fog.glsl",
          "cut.glsl", "skipping.glsl", "region.glsl"})
        code += shaderSource(file);
    return volume.paintCount > 0 ? code + paintSource(volume.paintCount) : code;
}

std::string memberSuffix(std::size_t number)
{
    return "_" + std::to_string(number);
}

std::string marchSource(const ProgramFeatures& volume)
{
    return memberCode(volume, true) + forEach(shaderSource("inorder.glsl"), {Names()});
}

std::string marchSource(const std::vector<ProgramFeatures>& members, bool inOrder)
{
    std::string source;
    std::vector<Names> names;
    bool surfaces = false, pieces = false, adapt = false;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const ProgramFeatures features = memberFeatures(members[i], inOrder);
        const std::string defines = features.defines() + (inOrder ? "" : "#define MEMBER\n");
        const std::string code = memberCode(features, inOrder);
        names.push_back({namesIn(code), memberSuffix(i)});
        source += undefined(defines) + defines +
                  withSuffix(code, names.back().suffix, names.back().names) + undefined(defines);
        surfaces = surfaces || rowOf(features.rayFunction).showsIsoValueOnly;
        adapt = adapt || features.adaptive;
        pieces = pieces || (features.cells && !features.tetrahedra);
    }
    if (inOrder) std::reverse(names.begin(), names.end());
    if (surfaces) source += "#define SURFACES\n";
    if (pieces && !inOrder) source += "#define PIECES\n";
    if (adapt && !inOrder) source += "#define STEPS_ADAPT\n";
    return source + forEach(shaderSource(inOrder ? "inorder.glsl" : "fused.glsl"), names);
}

} // namespace render
} // namespace osgVolumizer
