#pragma once

#include <osg/GLExtensions>
#include <osg/GraphicsThread>
#include <osgViewer/Viewer>

#include <mutex>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace support {

/// Listens to what drivers say of calls that are wrong or have no defined effect (KHR_debug), from
/// when a viewer is realized: set it as the viewer's realize operation. Errors that somebody takes
/// off count too.
class DebugOutput : public osg::GraphicsOperation
{
public:
    DebugOutput() : osg::Referenced(true), osg::GraphicsOperation("DebugOutput", false) {}

    void operator()(osg::GraphicsContext*) override
    {
        using Callback = void(GL_APIENTRY*)(Function, const void*);
        using Control =
            void(GL_APIENTRY*)(GLenum, GLenum, GLenum, GLsizei, const GLuint*, GLboolean);
        Callback callback = nullptr;
        Control control = nullptr;
        osg::setGLExtensionFuncPtr(callback, "glDebugMessageCallback", "glDebugMessageCallbackKHR");
        osg::setGLExtensionFuncPtr(control, "glDebugMessageControl", "glDebugMessageControlKHR");
        if (!callback || !control) return;
        listens = true;
        glEnable(DEBUG_OUTPUT);
        glEnable(DEBUG_OUTPUT_SYNCHRONOUS);
        control(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
        callback(&DebugOutput::hear, this);
    }

    bool listens = false;
    /// What was wrong, in the order in which it was said.
    std::vector<std::string> messages() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _messages;
    }

private:
    using Function = void(GL_APIENTRY*)(GLenum, GLenum, GLuint, GLenum, GLsizei, const char*,
                                        const void*);
    static constexpr GLenum DEBUG_OUTPUT = 0x92E0, DEBUG_OUTPUT_SYNCHRONOUS = 0x8242;
    static constexpr GLenum TYPE_ERROR = 0x824C, TYPE_UNDEFINED = 0x824E, SEVERITY_HIGH = 0x9146;

    static void GL_APIENTRY hear(GLenum, GLenum type, GLuint, GLenum severity, GLsizei,
                                 const char* message, const void* user)
    {
        if (type != TYPE_ERROR && type != TYPE_UNDEFINED && severity != SEVERITY_HIGH) return;
        const auto* self = static_cast<const DebugOutput*>(user);
        const std::lock_guard<std::mutex> lock(self->_mutex);
        self->_messages.emplace_back(message);
    }

    mutable std::mutex _mutex;
    mutable std::vector<std::string> _messages;
};

} // namespace support
} // namespace osgVolumizer
