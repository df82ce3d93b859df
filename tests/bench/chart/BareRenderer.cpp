// Before OSG, which declares only what OpenGL 1.1 has.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include "Renderer.h"

#include <support/OffscreenContext.h>
#include <support/OracleView.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

namespace osgVolumizer {
namespace bench {

namespace {

constexpr int TABLE_SIZE = 16384; // its error (nearest entry) does not show at any step here

const char* const vertexShader = "#version 330\n"
                                 "layout(location = 0) in vec3 position;\n"
                                 "uniform mat4 toClip;\n"
                                 "void main() { gl_Position = toClip * vec4(position, 1.0); }\n";

std::string readText(const std::string& file)
{
    std::ifstream in(file);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

// Table entries, or the sums of those before each.
std::vector<glm::vec4> tableTexels(const core::TransferFunction& function, bool integral)
{
    std::vector<glm::vec4> texels = function.tabulateExtinction(TABLE_SIZE, 0.0, 1.0, false);
    for (glm::vec4& t : texels)
        t.a *= float(1.0 / std::log(2.0));
    if (!integral) return texels;
    std::vector<glm::vec4> sums{glm::vec4(0.0f)};
    glm::dvec4 sum(0.0);
    for (const glm::vec4& t : texels) {
        sum += glm::dvec4(glm::dvec3(t) * double(t.a), t.a);
        sums.emplace_back(sum);
    }
    return sums;
}

class BareRenderer : public Renderer
{
public:
    explicit BareRenderer(bool integral) : _integral(integral) {}

    std::string name() const override { return _integral ? "bare march integral" : "bare march"; }
    Status open(const ChartScene& scene) override;
    Status setStep(double stepVoxel) override
    {
        _step = stepVoxel;
        return {};
    }
    void frame() override;
    support::FloatImage picture() override;

private:
    Status makeProgram();
    void makeVoxels(const ChartVolume& volume);
    void makeTable(const ChartVolume& volume);
    void makeBox(const ChartVolume& volume);
    void makeTarget();
    void setRays(const ChartScene& scene);
    GLint uniform(const char* name) const { return glGetUniformLocation(_program, name); }

    bool _integral;
    std::unique_ptr<support::OffscreenContext> _context; // frees what was made in it
    GLuint _program = 0;
    int _width = 0, _height = 0;
    GLsizei _vertexCount = 0;
    double _step = 1.0;
};

Status BareRenderer::makeProgram()
{
    const std::string fragment =
        std::string("#version 330\n") + (_integral ? "#define INTEGRAL\n" : "") +
        readText(OSGVOLUMIZER_SOURCE_DIR "/tests/bench/chart/march.frag.glsl");
    _program = glCreateProgram();
    const std::array<std::pair<GLenum, const char*>, 2> sources{
        {{GL_VERTEX_SHADER, vertexShader}, {GL_FRAGMENT_SHADER, fragment.c_str()}}};
    for (const auto& source : sources) {
        const GLuint shader = glCreateShader(source.first);
        glShaderSource(shader, 1, &source.second, nullptr);
        glCompileShader(shader);
        glAttachShader(_program, shader);
    }
    glLinkProgram(_program);
    GLint linked = 0;
    glGetProgramiv(_program, GL_LINK_STATUS, &linked);
    if (!linked) return Status(ErrorCode::NOT_SUPPORTED, "march.frag.glsl does not compile here");
    glUseProgram(_program);
    return {};
}

// As 32-bit floats whatever their type: exact filter weights, and the fastest there is on llvmpipe.
void BareRenderer::makeVoxels(const ChartVolume& volume)
{
    std::vector<float> fractions;
    for (double value : volume.values())
        fractions.push_back(float((value - volume.range.x) / (volume.range.y - volume.range.x)));
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, texture);
    const glm::ivec3 n = volume.size;
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, n.x, n.y, n.z, 0, GL_RED, GL_FLOAT, fractions.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
    const glm::vec3 scale(1.0 / glm::dvec3(n)), offset((0.5 - volume.origin) / glm::dvec3(n));
    glUniform1i(uniform("voxels"), 0);
    glUniform3fv(uniform("textureScale"), 1, glm::value_ptr(scale));
    glUniform3fv(uniform("textureOffset"), 1, glm::value_ptr(offset));
}

void BareRenderer::makeTable(const ChartVolume& volume)
{
    const std::vector<glm::vec4> texels =
        tableTexels(*core::TransferFunction::create(volume.table), _integral);
    GLuint buffer = 0, texture = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(texels.size() * sizeof(texels[0])), texels.data(),
                 GL_STATIC_DRAW);
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
    glUniform1i(uniform("table"), 1);
    glUniform1f(uniform("lastEntry"), float(TABLE_SIZE - 1));
}

void BareRenderer::makeTarget()
{
    GLuint color = 0, framebuffer = 0;
    glGenTextures(1, &color);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D, color);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, _width, _height, 0, GL_RGBA, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    glViewport(0, 0, _width, _height);
}

// The back faces of the box, so that each pixel is drawn once.
void BareRenderer::makeBox(const ChartVolume& volume)
{
    const glm::vec3 low(volume.boxMin()), high(volume.boxMax());
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    std::vector<glm::vec3> triangles;
    for (const auto& face : faces)
        for (const int k : {0, 1, 2, 0, 2, 3}) {
            const int i = face[k];
            triangles.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                                   i & 4 ? high.z : low.z);
        }
    _vertexCount = GLsizei(triangles.size());
    GLuint vertexArray = 0, buffer = 0;
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(triangles.size() * sizeof(glm::vec3)),
                 triangles.data(), GL_STATIC_DRAW);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    glUniform3fv(uniform("boxMin"), 1, glm::value_ptr(low));
    glUniform3fv(uniform("boxMax"), 1, glm::value_ptr(high));
}

// Origin and direction of rays as linear functions of (window x, y, 1): the eye and a point at
// depth 1, or in orthographic views a point of the eye plane and the view axis.
void BareRenderer::setRays(const ChartScene& scene)
{
    const glm::dmat4 view = support::toGlm(scene.view.view);
    const glm::dmat4 projection = support::toGlm(scene.view.projection);
    const glm::dmat4 toWorld = glm::inverse(view);
    const bool orthographic = projection[2][3] == 0.0;
    const auto windowToWorld = [&](double x, double y) {
        const glm::dvec2 ndc(2.0 * x / _width - 1.0, 2.0 * y / _height - 1.0);
        const int column = orthographic ? 3 : 2; // of the projection, what moves the centre
        const double sign = orthographic ? -1.0 : 1.0;
        const double eyeX = (ndc.x + sign * projection[column][0]) / projection[0][0];
        const double eyeY = (ndc.y + sign * projection[column][1]) / projection[1][1];
        return glm::dvec3(toWorld * (orthographic ? glm::dvec4(eyeX, eyeY, 0.0, 1.0)
                                                  : glm::dvec4(eyeX, eyeY, -1.0, 0.0)));
    };
    const glm::dvec3 corner = windowToWorld(0.0, 0.0);
    const glm::mat3 linear(windowToWorld(1.0, 0.0) - corner, windowToWorld(0.0, 1.0) - corner,
                           corner);
    glm::mat3 constant(0.0f);
    constant[2] = glm::vec3(orthographic ? -toWorld[2] : toWorld[3]);
    const glm::mat3& origin = orthographic ? linear : constant;
    const glm::mat3& direction = orthographic ? constant : linear;
    const glm::mat4 toClip(projection * view);
    glUniformMatrix3fv(uniform("rayOrigin"), 1, GL_FALSE, glm::value_ptr(origin));
    glUniformMatrix3fv(uniform("rayDirection"), 1, GL_FALSE, glm::value_ptr(direction));
    glUniformMatrix4fv(uniform("toClip"), 1, GL_FALSE, glm::value_ptr(toClip));
}

Status BareRenderer::open(const ChartScene& scene)
{
    if (scene.shaded) return Status(ErrorCode::NOT_SUPPORTED, "has no shading");
    if (!scene.isOneVolume()) return Status(ErrorCode::NOT_SUPPORTED, "draws one volume");
    auto context = support::OffscreenContext::create();
    if (!context.ok()) return context.status;
    _context = std::move(*context);
    _context->makeCurrent();
    _width = scene.view.width;
    _height = scene.view.height;
    const Status status = makeProgram();
    if (status.ok()) {
        makeVoxels(scene.volumes.front());
        makeTable(scene.volumes.front());
        makeTarget();
        makeBox(scene.volumes.front());
        setRays(scene);
    }
    _context->release();
    return status;
}

void BareRenderer::frame()
{
    _context->makeCurrent();
    glClear(GL_COLOR_BUFFER_BIT);
    glUniform1f(uniform("stepLength"), float(_step));
    glDrawArrays(GL_TRIANGLES, 0, _vertexCount);
    glFinish();
    _context->release();
}

support::FloatImage BareRenderer::picture()
{
    _context->makeCurrent();
    support::FloatImage image(_width, _height);
    glReadPixels(0, 0, _width, _height, GL_RGBA, GL_FLOAT, image.pixels.data());
    if (const GLenum error = glGetError()) std::cerr << name() << ": GL error " << error << "\n";
    _context->release();
    return image;
}

} // namespace

RendererPtr makeBareRenderer(bool integral)
{
    return std::make_unique<BareRenderer>(integral);
}

} // namespace bench
} // namespace osgVolumizer
