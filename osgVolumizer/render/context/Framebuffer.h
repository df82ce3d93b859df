#pragma once

#include "ContextResources.h"

#include <vector>

namespace osgVolumizer {
namespace render {

/// What OSG draws a view into, as far as volumes have to know it.
struct Framebuffer
{
    GLuint draw = 0, read = 0; ///< names of what is drawn to and read from; 0: the window
    /// Per output location of a shader, up to the last one that goes anywhere.
    std::vector<GLenum> drawBuffers;
    bool multisampled = false;
    int colorBits = 0; ///< of one channel of the first draw buffer
    int depthBits = 0, stencilBits = 0;
    bool floatDepth = false;

    /// Whether the first output of a shader goes anywhere.
    bool hasColor() const { return colorBits > 0; }
};

/// Asks what the context draws to now. Call in the draw thread.
Framebuffer queryFramebuffer(const ContextResources& resources);

/// A format of depth textures that depths, and stencil values, can be blitted to and from. GL wants
/// the very same format, and does not tell that of a window, so formats are tried. GL_NONE where
/// none fits. Leaves bindings as they were.
/// \param what GL_DEPTH_BUFFER_BIT, GL_STENCIL_BUFFER_BIT or both
GLenum findBlitFormat(osg::GLExtensions& gl, const ContextResources& resources,
                      const Framebuffer& framebuffer, GLbitfield what);

/// Whether a depth format has stencil values too.
bool hasStencil(GLenum depthFormat);

/// Attaches what the second and further outputs of shaders go to also to another framebuffer, of
/// one's own, whose first colour attachment stays: at the attachment of their location. Leaves it
/// bound for drawing.
/// \return its draw buffers; only the first one where what there is cannot be shared
std::vector<GLenum> shareAttachments(osg::GLExtensions& gl, const ContextResources& resources,
                                     const Framebuffer& framebuffer, GLuint target);
/// Takes what was shared off again.
void unshareAttachments(osg::GLExtensions& gl, GLuint target, std::size_t drawBufferCount);

/// Limits drawing, or a blit, to the first of a framebuffer's draw buffers, and puts back the
/// others.
class FirstDrawBufferScope
{
public:
    /// \param drawBuffers of the framebuffer that is bound for drawing
    FirstDrawBufferScope(osg::GLExtensions& gl, const std::vector<GLenum>& drawBuffers);
    FirstDrawBufferScope(const FirstDrawBufferScope&) = delete;
    FirstDrawBufferScope& operator=(const FirstDrawBufferScope&) = delete;
    ~FirstDrawBufferScope();

private:
    osg::GLExtensions& _gl;
    const std::vector<GLenum>& _drawBuffers;
};

/// Lets reads from the framebuffer bound for reading come from one of its colour buffers, and puts
/// back which it was.
class ReadBufferScope
{
public:
    explicit ReadBufferScope(GLenum buffer);
    ReadBufferScope(const ReadBufferScope&) = delete;
    ReadBufferScope& operator=(const ReadBufferScope&) = delete;
    ~ReadBufferScope();

private:
    GLint _before = GL_NONE;
};

} // namespace render
} // namespace osgVolumizer
