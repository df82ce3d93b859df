#include "ContextLimits.h"

#include <osg/GLExtensions>

#include <cstring>
#include <mutex>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double NEEDED_VERSION = 3.3; // shaders, and what they fetch from

std::mutex& mockMutex()
{
    static std::mutex mutex;
    return mutex;
}

std::function<void(ContextLimits&)>& mock()
{
    static std::function<void(ContextLimits&)> change;
    return change;
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
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    limits.filtersFloatsBest = renderer && std::strstr(renderer, "llvmpipe");
    std::lock_guard<std::mutex> lock(mockMutex());
    if (mock()) mock()(limits);
    return limits;
}

int texture3DSizeOf(unsigned contextId)
{
    const osg::GLExtensions* gl = osg::GLExtensions::Get(contextId, false);
    if (!gl) return 0;
    ContextLimits limits;
    limits.texture3DSize = gl->maxTexture3DSize;
    std::lock_guard<std::mutex> lock(mockMutex());
    if (mock()) mock()(limits);
    return limits.texture3DSize;
}

void mockContextLimits(std::function<void(ContextLimits&)> change)
{
    std::lock_guard<std::mutex> lock(mockMutex());
    mock() = std::move(change);
}

} // namespace render
} // namespace osgVolumizer
