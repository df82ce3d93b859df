#include <osgVolumizer/render/context/ShaderSource.h>
#include <osgVolumizer/render/draw/RayFunctions.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

namespace RayFunctionsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::render;

namespace {

std::string read(const std::string& path)
{
    std::ifstream stream(std::string(OSGVOLUMIZER_SOURCE_DIR) + "/" + path);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

// The values of an enumeration, as its declaration lists them.
std::vector<std::string> enumerators(const std::string& header, const std::string& name)
{
    std::string body = header.substr(header.find("enum " + name));
    body = body.substr(body.find('{') + 1);
    body = body.substr(0, body.find('}'));
    body = std::regex_replace(body, std::regex("//[^\n]*"), "");
    const std::regex identifier("[A-Z_]+");
    std::vector<std::string> names;
    for (std::sregex_iterator i(body.begin(), body.end(), identifier), end; i != end; ++i)
        names.push_back(i->str());
    return names;
}

std::vector<VolumeAppearance::RayFunction> functions()
{
    std::vector<VolumeAppearance::RayFunction> all;
    for (std::size_t i = 0; i < std::size(VolumeAppearance::RAY_FUNCTION_NAMES); ++i)
        all.push_back(static_cast<VolumeAppearance::RayFunction>(i));
    return all;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST(RayFunctions, EveryValueHasItsName)
{
    const std::vector<std::string> names =
        enumerators(read("osgVolumizer/VolumeAppearance.h"), "RayFunction");
    ASSERT_GE(names.size(), 6u);
    EXPECT_EQ(names, std::vector<std::string>(std::begin(VolumeAppearance::RAY_FUNCTION_NAMES),
                                              std::end(VolumeAppearance::RAY_FUNCTION_NAMES)));
}

TEST(RayFunctions, EveryValueHasItsRowAndAShaderOfItsOwn)
{
    std::set<std::string> first;
    for (const auto function : functions()) {
        const RayFunctionRow& row = rowOf(function);
        EXPECT_EQ(row.function, function);
        ASSERT_FALSE(row.shaders.empty());
        EXPECT_TRUE(first.insert(row.shaders.front()).second) << row.shaders.front();
        for (const std::string& shader : row.shaders)
            EXPECT_NE(shaderSource(shader), "") << shader;
    }
}

TEST(RayFunctions, ShadersDefineWhatTheirRowsNeed)
{
    for (const auto function : functions()) {
        const RayFunctionRow& row = rowOf(function);
        const std::string source = rayShaderSource(function);
        EXPECT_TRUE(contains(source, "vec4 march(")) << row.shaders.front();
        EXPECT_EQ(contains(source, "vec4 slice("), !row.needsSlabs) << row.shaders.front();
        EXPECT_EQ(contains(source, "float gatheredEntry("), row.gathers) << row.shaders.front();
        EXPECT_EQ(row.gathers, row.blendEquation != GL_NONE);
        EXPECT_FALSE(row.gathers && row.integratesLight);
    }
}

TEST(RayFunctions, NoOtherFileNamesThem)
{
    // A file that did would have to be changed for a new one.
    for (const char* file : {"slab.glsl", "slice.frag.glsl", "resolve.frag.glsl", "transfer.glsl"})
        for (const char* name : VolumeAppearance::RAY_FUNCTION_NAMES)
            EXPECT_FALSE(contains(shaderSource(file), name)) << file << ", " << name;
    for (const char* file : {"draw/VolumeProgram.cpp", "draw/RayTarget.cpp",
                             "draw/ProgramFeatures.cpp", "cull/BrickSelection.cpp"})
        for (const char* name : VolumeAppearance::RAY_FUNCTION_NAMES)
            EXPECT_FALSE(contains(read(std::string("osgVolumizer/render/") + file),
                                  std::string("VolumeAppearance::") + name))
                << file << ", " << name;
}

} // namespace RayFunctionsTest
