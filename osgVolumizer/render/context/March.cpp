#include "March.h"

#include "ContextHooks.h"
#include "GLErrors.h"
#include "ProgramInterface.h"
#include "ReportOnce.h"
#include "ScreenPass.h"
#include "ShaderSource.h"
#include "StateScope.h"
#include "TargetBuffers.h"
#include "Uniforms.h"

#include <osg/Program>
#include <osg/Texture3D>

#include <algorithm>
#include <atomic>
#include <cstdlib>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double COMPUTE_VERSION = 4.3;
constexpr int PROBE_SIDE = 256;        // pixels of the probe
constexpr int MOST_STEPS = 1024;       // of its rays
constexpr double ENOUGH_TIME = 1e-3;   // s; what a frame is, to be measured well
constexpr double WORTHWHILE = 0.8;     // of the time of fragments
constexpr GLenum QUERY_TIME = 0x88BF;  // GL_TIME_ELAPSED
constexpr GLenum QUERY_VALUE = 0x8866; // GL_QUERY_RESULT

constexpr int FASTER = -1; // what is asked for: that, or a march

// What the environment asks for.
int askedByUser()
{
    const char* const variable = std::getenv("OSGVOLUMIZER_MARCH");
    const std::string value = variable ? variable : "";
    if (value == "fragments") return static_cast<int>(March::FRAGMENTS);
    if (value == "compute") return static_cast<int>(March::COMPUTE);
    if (!value.empty())
        reportOnce(
            {ErrorCode::VALUE_INVALID, "OSGVOLUMIZER_MARCH is \"" + value +
                                           "\", not \"fragments\" or \"compute\"; the faster "
                                           "one is taken"});
    return FASTER;
}

std::atomic<int>& asked()
{
    static std::atomic<int> march{askedByUser()};
    return march;
}

struct MarchChoice : ContextPart
{
    std::optional<March> march; // none: not measured yet
    bool refused = false;

    void release(osg::GLExtensions&) override {}
};

bool canCompute(const osg::State& state, const ContextResources& resources)
{
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    return resources.limits.version + 0.01 >= COMPUTE_VERSION && gl.glDispatchCompute &&
           gl.glMemoryBarrier && gl.isBindImageTextureSupported();
}

osg::ref_ptr<osg::Program> makeProbe(const std::string& computeHeader)
{
    const std::string defines = "#define SIDE " + std::to_string(PROBE_SIDE) + "\n";
    const std::string code = shaderSource("pixel.glsl") + shaderSource("march.probe.glsl");
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgVolumizer probe");
    if (!computeHeader.empty()) {
        program->addShader(makeShader(osg::Shader::COMPUTE, computeHeader + defines, code));
        return program;
    }
    const std::string header = "#version 330\n" + defines;
    program->addShader(makeShader(osg::Shader::VERTEX, header, shaderSource("screen.vert.glsl")));
    program->addShader(makeShader(osg::Shader::FRAGMENT, header, code));
    return program;
}

osg::ref_ptr<osg::Texture3D> makeTexels()
{
    constexpr int COUNT = 16;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(COUNT, COUNT, COUNT, GL_RED, GL_FLOAT);
    auto* texels = reinterpret_cast<float*>(image->data());
    for (int i = 0; i < COUNT * COUNT * COUNT; ++i)
        texels[i] = static_cast<float>(i % 7) / 7.0f;
    osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D(image);
    texture->setInternalFormat(GL_R32F);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    return texture;
}

// Draws the probe, and tells how long the card took.
class Probe
{
public:
    Probe(osg::State& state, ContextResources& resources)
        : _state(state), _gl(*state.get<osg::GLExtensions>()), _resources(resources), _scope(state),
          _texels(makeTexels())
    {
        _gl.glGenQueries(1, &_query);
        _made = _target.ensure(state, PROBE_SIDE, PROBE_SIDE);
        if (!_made) return;
        _gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, _target.framebuffer);
        glViewport(0, 0, PROBE_SIDE, PROBE_SIDE);
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
        glClear(GL_COLOR_BUFFER_BIT);
        glEnable(GL_BLEND);
        _gl.glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    ~Probe()
    {
        _gl.glDeleteQueries(1, &_query);
        deleteFramebuffers(_gl, {&_target.framebuffer});
        _state.haveAppliedTextureAttribute(UNIT_VOXELS, osg::StateAttribute::TEXTURE);
    }
    Probe(const Probe&) = delete;
    Probe& operator=(const Probe&) = delete;

    // Seconds; 0 where the card refuses anything.
    double measure(osg::Program& program, bool compute, int steps)
    {
        program.apply(_state);
        const auto* linked = program.getPCP(_state);
        if (!_made || !linked || !linked->isLinked()) return 0.0;
        _state.applyTextureAttribute(UNIT_VOXELS, _texels);
        const Uniforms uniforms(_gl, *linked);
        uniforms.set("texels", int(UNIT_VOXELS));
        uniforms.set("steps", steps);
        if (compute) uniforms.set("area", glm::vec4(0.0f, 0.0f, PROBE_SIDE, PROBE_SIDE));
        draw(compute); // whatever is done once
        double least = 0.0;
        for (int round = 0; round < 2; ++round) {
            const double seconds = time(compute);
            least = round == 0 ? seconds : std::min(least, seconds);
        }
        return glGetError() == GL_NO_ERROR ? least : 0.0;
    }

private:
    void draw(bool compute)
    {
        if (compute)
            runCompute(_state, *_target.color, GL_RGBA32F_ARB, PROBE_SIDE, PROBE_SIDE);
        else
            drawScreen(_state, _resources, {0, 0, PROBE_SIDE, PROBE_SIDE});
    }
    double time(bool compute)
    {
        GLuint64 nanoseconds = 0;
        _gl.glBeginQuery(QUERY_TIME, _query);
        draw(compute);
        _gl.glEndQuery(QUERY_TIME);
        _gl.glGetQueryObjectui64v(_query, QUERY_VALUE, &nanoseconds);
        return 1e-9 * static_cast<double>(nanoseconds);
    }

    osg::State& _state;
    osg::GLExtensions& _gl;
    ContextResources& _resources;
    const StateScope _scope;
    const osg::ref_ptr<osg::Texture3D> _texels;
    FloatTarget _target;
    GLuint _query = 0;
    bool _made = false;
};

MarchTimes measure(osg::State& state, ContextResources& resources)
{
    MarchTimes times;
    if (!resources.limits.floatTargets || !state.get<osg::GLExtensions>()->isTimerQuerySupported)
        return times;
    discardErrors();
    {
        Probe probe(state, resources);
        const osg::ref_ptr<osg::Program> fragments = makeProbe({}),
                                         compute = makeProbe(computeHeader(state));
        int steps = 4;
        while ((times.fragments = probe.measure(*fragments, false, steps)) < ENOUGH_TIME &&
               times.fragments > 0.0 && steps < MOST_STEPS)
            steps *= 4;
        times.compute = probe.measure(*compute, true, steps);
    }
    discardErrors();
    const ContextHooks* hooks = ContextHooks::of(state);
    if (hooks && hooks->changeMarchTimes) hooks->changeMarchTimes(times);
    return times;
}

March measuredMarch(osg::State& state, ContextResources& resources)
{
    const MarchTimes times = measure(state, resources);
    OSG_INFO << "osgVolumizer: context " << state.getContextID() << " marches a probe in "
             << 1e3 * times.fragments << " ms by fragments, " << 1e3 * times.compute
             << " ms by compute shaders" << std::endl;
    if (!(times.fragments > 0.0 && times.compute > 0.0))
        reportOnce({ErrorCode::NOT_SUPPORTED,
                    "how fast compute shaders march could not be measured; fragments do it"});
    return fasterMarch(times);
}

} // namespace

March fasterMarch(const MarchTimes& times)
{
    const bool measured = times.fragments > 0.0 && times.compute > 0.0;
    return measured && times.compute < WORTHWHILE * times.fragments ? March::COMPUTE
                                                                    : March::FRAGMENTS;
}

March marchOf(osg::State& state, ContextResources& resources)
{
    MarchChoice& choice = resources.part<MarchChoice>();
    const std::optional<March> wanted = askedMarch();
    if (choice.refused || wanted == March::FRAGMENTS) return March::FRAGMENTS;
    if (!canCompute(state, resources)) {
        if (wanted) refuseCompute(resources, "the context has no OpenGL 4.3");
        return March::FRAGMENTS;
    }
    if (wanted) return *wanted;
    if (!choice.march) choice.march = measuredMarch(state, resources);
    return *choice.march;
}

void refuseCompute(ContextResources& resources, const std::string& reason)
{
    resources.part<MarchChoice>().refused = true;
    reportOnce({ErrorCode::NOT_SUPPORTED,
                reason + "; volumes are not marched by compute shaders there, but by fragments"});
}

void setMarch(std::optional<March> march)
{
    asked() = march ? static_cast<int>(*march) : FASTER;
}

std::optional<March> askedMarch()
{
    const int march = asked();
    return march == FASTER ? std::nullopt : std::optional<March>(static_cast<March>(march));
}

std::string computeHeader(const osg::State& state)
{
    const ContextHooks* hooks = ContextHooks::of(state);
    return "#version 430\n#define COMPUTE\n#define TARGET_UNIT " + std::to_string(UNIT_TARGET) +
           "\n" + (hooks ? hooks->computeHeader : std::string());
}

void runCompute(osg::State& state, const osg::Texture& target, GLenum format, int width, int height)
{
    constexpr int GROUP = 8; // pixels a side, as in pixel.glsl
    constexpr GLbitfield BARRIERS = GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    gl.glBindImageTexture(UNIT_TARGET, textureName(state, target), 0, GL_FALSE, 0, GL_READ_WRITE,
                          format);
    gl.glDispatchCompute(static_cast<GLuint>((width + GROUP - 1) / GROUP),
                         static_cast<GLuint>((height + GROUP - 1) / GROUP), 1);
    gl.glMemoryBarrier(BARRIERS);
    gl.glBindImageTexture(UNIT_TARGET, 0, 0, GL_FALSE, 0, GL_READ_WRITE, format);
    state.haveAppliedAttribute(osg::StateAttribute::BINDIMAGETEXTURE, UNIT_TARGET);
}

} // namespace render
} // namespace osgVolumizer
