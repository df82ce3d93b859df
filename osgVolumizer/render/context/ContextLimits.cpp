#include "ContextLimits.h"

#include "ContextHooks.h"

#include <osg/GLExtensions>

#include <atomic>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double NEEDED_VERSION = 3.3; // shaders, and what they fetch from

std::atomic<int> filterBitsOfAll{0};

void changeByHooks(ContextLimits& limits, const osg::State& state)
{
    const ContextHooks* hooks = ContextHooks::of(state);
    if (hooks && hooks->changeLimits) hooks->changeLimits(limits);
}

// What OSG has asked a context for.
ContextLimits knownLimits(const osg::State& state)
{
    ContextLimits limits;
    const osg::GLExtensions* gl = osg::GLExtensions::Get(state.getContextID(), false);
    if (!gl) return limits;
    limits.texture3DSize = gl->maxTexture3DSize;
    limits.textureUnits = gl->glMaxTextureUnits;
    changeByHooks(limits, state);
    return limits;
}

std::string oneDecimal(double value)
{
    const std::string text = std::to_string(value + 0.05);
    return text.substr(0, text.find('.') + 2);
}

} // namespace

Status ContextLimits::check() const
{
    if (version + 0.01 < NEEDED_VERSION)
        return {ErrorCode::NOT_SUPPORTED, "the context has OpenGL " + oneDecimal(version) +
                                              ", but volumes need " + oneDecimal(NEEDED_VERSION) +
                                              "; they are not drawn"};
    if (texture3DSize < 1)
        return {ErrorCode::NOT_SUPPORTED, "the context has no 3D textures; volumes are not drawn"};
    return {};
}

ContextLimits queryContextLimits(osg::State& state)
{
    ContextLimits limits;
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    limits.version = static_cast<double>(gl.glVersion);
    limits.floatTargets =
        gl.glVersion >= 3.0f ||
        osg::isGLExtensionSupported(state.getContextID(), "GL_ARB_color_buffer_float");
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limits.texture3DSize);
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &limits.textureUnits);
    limits.filterBits = filterBitsOfAll;
    changeByHooks(limits, state);
    return limits;
}

void setPrecision(ContextLimits& limits, const Precision& precision, const osg::State& state)
{
    limits.precision = precision;
    // Results of 8 bits come from arithmetic of 8 bits, beside which floats have a path of their
    // own.
    limits.filtersFloatsBest = precision.measured && precision.byteTexel > 0.25 / 255.0;
    changeByHooks(limits, state);
}

int texture3DSizeOf(const osg::State& state)
{
    return knownLimits(state).texture3DSize;
}

int textureUnitsOf(const osg::State& state)
{
    return knownLimits(state).textureUnits;
}

int filterBitsOf(const osg::State& state)
{
    ContextLimits limits;
    limits.filterBits = filterBitsOfAll;
    changeByHooks(limits, state);
    return limits.filterBits;
}

void setFilterBits(int bits)
{
    filterBitsOfAll = bits;
}

} // namespace render
} // namespace osgVolumizer
