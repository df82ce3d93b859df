#include <osgVolumizer/render/context/ShaderSource.h>
#include <osgVolumizer/render/context/Uniforms.h>

#include <gtest/gtest.h>

namespace ShaderSourceTest {

using namespace osgVolumizer::render;

namespace {

const std::string HEADER = "#version 330\n#define SOMETHING\n";

std::string textOf(const std::string& code)
{
    return makeShader(osg::Shader::FRAGMENT, HEADER, code)->getShaderSource();
}

std::string define(const std::string& name)
{
    return "#define " + name + " " + uniformName(name) + "\n";
}

} // namespace

TEST(ShaderSource, UniformsAreRenamedBetweenHeaderAndCode)
{
    const std::string code = "uniform float step;\nvoid main() { gl_FragColor = vec4(step); }\n";
    EXPECT_EQ(textOf(code), HEADER + define("step") + code);
    EXPECT_EQ(uniformName("step"), "osgVolumizer_step");
}

TEST(ShaderSource, EveryNameOfADeclarationIsRenamed)
{
    const std::string code = "uniform vec3 low, high;  // of the box\n"
                             "  uniform vec4 planes[8];\n"
                             "uniform vec2 a[4], b ,c2_;\n";
    EXPECT_EQ(textOf(code), HEADER + define("low") + define("high") + define("planes") +
                                define("a") + define("b") + define("c2_") + code);
}

TEST(ShaderSource, NothingElseIsRenamed)
{
    for (const char* code : {"in vec3 position;\nout vec4 color;\n", "// uniform float notOne;\n",
                             "float uniformly(float x) { return x; }\n",
                             "flat in float spacing; uniform float x\n", "uniform\n", ""})
        EXPECT_EQ(textOf(code), HEADER + code);
}

TEST(ShaderSource, FilesAreKnownByTheirPathsBelowShaders)
{
    EXPECT_NE(shaderSource("slab.glsl").find("void main()"), std::string::npos);
    EXPECT_NE(shaderSource("rays/sum.glsl").find("gatheredEntry"), std::string::npos);
    EXPECT_EQ(shaderSource("sum.glsl"), "");
    EXPECT_EQ(shaderSource("nothing.glsl"), "");
}

TEST(ShaderSource, NamesOfCodeAreThoseAtFileScope)
{
    const std::string code = "uniform vec3 low, high; // of the box\n"
                             "#define LENGTH vec3(1.0)\n#define CHANNEL(t) (t).r\n"
                             "const float SAME = 1e-4;\nfloat entry, run[4];\n"
                             "#ifdef FLAG\nvec4 valueAt(vec3 place, float bias)\n{\n"
                             "    float local = 1.0;\n    return vec4(local);\n}\n#endif\n";
    const std::set<std::string> expected = {"low",  "high",  "LENGTH", "CHANNEL",
                                            "SAME", "entry", "run",    "valueAt"};
    EXPECT_EQ(namesIn(code), expected);
}

TEST(ShaderSource, CodeWithASuffixHasNoNameOfTheCodeWithout)
{
    const std::string code = "uniform float step;\nfloat twice(float x) { return x + step; }\n";
    EXPECT_EQ(withSuffix(code, "_3"),
              "uniform float step_3;\nfloat twice_3(float x) { return x + step_3; }\n");
    // Names in names, and of fields, stay.
    EXPECT_EQ(withSuffix("stepped = step.x + my_step;", "_1", {"step"}),
              "stepped = step_1.x + my_step;");
}

} // namespace ShaderSourceTest
