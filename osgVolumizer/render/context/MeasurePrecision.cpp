#include "MeasurePrecision.h"

#include "GLErrors.h"
#include "ReportOnce.h"
#include "ScreenPass.h"
#include "ShaderSource.h"
#include "StateScope.h"
#include "TargetBuffers.h"

#include <osg/Program>

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

constexpr int SIDE = 64; // of the picture: as many fractions as it has pixels

osg::ref_ptr<osg::Program> makeProgram(int filterBits)
{
    const std::string version = "#version 330\n#define SIDE " + std::to_string(SIDE) + "\n";
    const std::string bits =
        filterBits > 0 ? "#define FILTER_BITS " + std::to_string(filterBits) + "\n" : "";
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgVolumizer precision");
    program->addShader(makeShader(osg::Shader::VERTEX, version, shaderSource("screen.vert.glsl")));
    program->addShader(
        makeShader(osg::Shader::FRAGMENT, version + bits,
                   shaderSource("filtering.glsl") + shaderSource("precision.frag.glsl")));
    return program;
}

// Two texels along x, filtered and held at the edges as those of volumes are, on a unit.
GLuint makeTexture(osg::GLExtensions& gl, unsigned unit, GLenum internalFormat, GLenum type,
                   const void* texels)
{
    GLuint name = 0;
    glGenTextures(1, &name);
    gl.glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_3D, name);
    gl.glTexImage3D(GL_TEXTURE_3D, 0, static_cast<GLint>(internalFormat), 2, 1, 1, 0, GL_RED, type,
                    texels);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
    return name;
}

// GL names that live as long as a measurement.
struct GLNames
{
    explicit GLNames(osg::GLExtensions& extensions) : gl(extensions)
    {
        constexpr float floats[] = {0.0f, 1.0f};
        constexpr unsigned char bytes[] = {0, 1, 0, 0};
        textures[0] = makeTexture(gl, 0, GL_R32F, GL_FLOAT, floats);
        textures[1] = makeTexture(gl, 1, GL_R8, GL_UNSIGNED_BYTE, bytes);
        gl.glGenRenderbuffers(1, &renderbuffer);
        gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, renderbuffer);
        gl.glRenderbufferStorage(GL_RENDERBUFFER_EXT, GL_RGBA32F_ARB, SIDE, SIDE);
        bindOwn(gl, framebuffer);
        gl.glFramebufferRenderbuffer(GL_FRAMEBUFFER_EXT, GL_COLOR_ATTACHMENT0_EXT,
                                     GL_RENDERBUFFER_EXT, renderbuffer);
    }
    ~GLNames()
    {
        gl.glDeleteFramebuffers(1, &framebuffer);
        gl.glDeleteRenderbuffers(1, &renderbuffer);
        glDeleteTextures(2, textures);
    }
    GLNames(const GLNames&) = delete;
    GLNames& operator=(const GLNames&) = delete;

    osg::GLExtensions& gl;
    GLuint textures[2] = {}, renderbuffer = 0, framebuffer = 0;
};

// One pass without blending, and one that blends its third channel over that.
void drawFractions(osg::State& state, ContextResources& resources)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const glm::ivec4 area(0, 0, SIDE, SIDE);
    glViewport(0, 0, SIDE, SIDE);
    glClearColor(-1.0f, -1.0f, -1.0f, -1.0f); // no value that is drawn
    glClear(GL_COLOR_BUFFER_BIT);
    setUniform(state, "floatTexels", 0);
    setUniform(state, "byteTexels", 1);
    setUniform(state, "blended", 0);
    drawScreen(state, resources, area);
    setUniform(state, "blended", 1);
    glEnable(GL_BLEND);
    gl.glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glColorMask(GL_FALSE, GL_FALSE, GL_TRUE, GL_FALSE);
    drawScreen(state, resources, area);
}

// The pixels, row by row; none where something is refused.
std::vector<glm::vec4> readFractions(osg::State& state, ContextResources& resources)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    std::vector<glm::vec4> pixels;
    if (!resources.limits.floatTargets) return pixels;
    discardErrors();
    const StateScope scope(state);
    const GLNames names(gl);
    const osg::ref_ptr<osg::Program> program = makeProgram(resources.limits.filterBits);
    program->apply(state);
    const auto* linked = program->getPCP(state);
    if (linked && linked->isLinked() && glGetError() == GL_NO_ERROR &&
        gl.glCheckFramebufferStatus(GL_FRAMEBUFFER_EXT) == GL_FRAMEBUFFER_COMPLETE_EXT) {
        drawFractions(state, resources);
        pixels.resize(SIDE * SIDE);
        glReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_FLOAT, pixels.data());
        if (glGetError() != GL_NO_ERROR) pixels.clear();
    }
    discardErrors();
    return pixels;
}

Precision compare(const std::vector<glm::vec4>& pixels)
{
    Precision p{0.0, 0.0, 0.0, true};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double f = double(i) / double(pixels.size());
        const glm::dvec4 pixel(pixels[i]);
        const double blended = 0.25 * f + (1.0 - f) * (1.0 - 0.75 * f);
        p.filterWeight = std::max(p.filterWeight, std::abs(pixel.r - f));
        p.byteTexel = std::max(p.byteTexel, std::abs(pixel.g - f / 255.0));
        p.blend = std::max(p.blend, std::abs(pixel.b - blended));
        p.measured = p.measured && pixel.r >= 0.0 && pixel.a == 1.0;
    }
    p.byteTexel = std::max(p.byteTexel - p.filterWeight / 255.0, 0.0);
    return p.measured ? p : Precision();
}

} // namespace

Precision measurePrecision(osg::State& state, ContextResources& resources)
{
    const std::vector<glm::vec4> pixels = readFractions(state, resources);
    const Precision precision = pixels.empty() ? Precision() : compare(pixels);
    if (!precision.measured)
        reportOnce({ErrorCode::NOT_SUPPORTED, "the precision of the context could not be measured; "
                                              "that of 8-bit weights is assumed"});
    OSG_INFO << "osgVolumizer: context " << state.getContextID() << " filters with weights to "
             << precision.filterWeight << ", 8-bit texels to " << precision.byteTexel
             << " of their range, and blends to " << precision.blend
             << (precision.measured ? "" : " (assumed)") << std::endl;
    return precision;
}

} // namespace render
} // namespace osgVolumizer
