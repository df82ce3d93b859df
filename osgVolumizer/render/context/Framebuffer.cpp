#include "Framebuffer.h"

#include "GLErrors.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

constexpr GLenum FIRST_DRAW_BUFFER = 0x8825; // GL_DRAW_BUFFER0
constexpr GLenum ATTACHMENT_COMPONENT_TYPE = 0x8211, FLOAT_COMPONENTS = 0x1406;

// A window's buffers have one name to be drawn to and another to be asked for.
GLenum attachmentOf(GLenum drawBuffer)
{
    switch (drawBuffer) {
    case GL_BACK:
        return GL_BACK_LEFT;
    case GL_FRONT:
    case GL_LEFT:
    case GL_FRONT_AND_BACK:
        return GL_FRONT_LEFT;
    case GL_RIGHT:
        return GL_FRONT_RIGHT;
    default:
        return drawBuffer;
    }
}

// A property of an attachment of the framebuffer that is drawn to; 0 where there is none.
GLint ask(const ContextResources& resources, GLenum attachment, GLenum parameter)
{
    GLint type = GL_NONE, value = 0;
    resources.glGetFramebufferAttachmentParameteriv(
        GL_DRAW_FRAMEBUFFER_EXT, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE_EXT, &type);
    if (type != GL_NONE)
        resources.glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER_EXT, attachment,
                                                        parameter, &value);
    return value;
}

std::vector<GLenum> queryDrawBuffers()
{
    GLint most = 1;
    glGetIntegerv(GL_MAX_DRAW_BUFFERS, &most);
    std::vector<GLenum> buffers;
    for (GLint i = 0; i < most; ++i) {
        GLint buffer = GL_NONE;
        glGetIntegerv(FIRST_DRAW_BUFFER + static_cast<GLenum>(i), &buffer);
        buffers.push_back(static_cast<GLenum>(buffer));
    }
    while (!buffers.empty() && buffers.back() == GL_NONE)
        buffers.pop_back();
    return buffers;
}

// Formats in the order in which they are likely to be a framebuffer's.
std::vector<GLenum> likelyFormats(const Framebuffer& framebuffer, GLbitfield what)
{
    std::vector<GLenum> formats = {GL_DEPTH24_STENCIL8_EXT, GL_DEPTH32F_STENCIL8};
    if (framebuffer.floatDepth) std::swap(formats[0], formats[1]);
    if (what & GL_STENCIL_BUFFER_BIT) return formats;
    const std::vector<GLenum> plain =
        framebuffer.floatDepth
            ? std::vector<GLenum>{GL_DEPTH_COMPONENT32F}
            : std::vector<GLenum>{GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT32};
    formats.insert(framebuffer.stencilBits > 0 ? formats.end() : formats.begin(), plain.begin(),
                   plain.end());
    return formats;
}

// The format of the depths of the framebuffer that is drawn to where they are in a render buffer,
// which alone tells whatever it holds; else GL_NONE.
GLenum renderbufferFormat(osg::GLExtensions& gl, const ContextResources& resources,
                          const Framebuffer& framebuffer, GLbitfield what)
{
    if (framebuffer.draw == 0) return GL_NONE;
    const GLenum attachment = what & GL_DEPTH_BUFFER_BIT ? GLenum(GL_DEPTH_ATTACHMENT_EXT)
                                                         : GLenum(GL_STENCIL_ATTACHMENT_EXT);
    if (ask(resources, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE_EXT) !=
        GL_RENDERBUFFER_EXT)
        return GL_NONE;
    GLint bound = 0, format = GL_NONE;
    glGetIntegerv(GL_RENDERBUFFER_BINDING_EXT, &bound);
    const GLint name = ask(resources, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME_EXT);
    gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, static_cast<GLuint>(name));
    gl.glGetRenderbufferParameteriv(GL_RENDERBUFFER_EXT, GL_RENDERBUFFER_INTERNAL_FORMAT_EXT,
                                    &format);
    gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, static_cast<GLuint>(bound));
    return static_cast<GLenum>(format);
}

// Formats to be tried. Trials that fail are errors to whoever listens, so what is known comes
// first.
std::vector<GLenum> candidates(osg::GLExtensions& gl, const ContextResources& resources,
                               const Framebuffer& framebuffer, GLbitfield what)
{
    std::vector<GLenum> formats = likelyFormats(framebuffer, what);
    const auto known = std::find(formats.begin(), formats.end(),
                                 renderbufferFormat(gl, resources, framebuffer, what));
    if (known != formats.end()) std::rotate(formats.begin(), known, known + 1);
    return formats;
}

// Whether a pixel can be blitted from the framebuffer to a buffer of the format.
bool canBlit(osg::GLExtensions& gl, const Framebuffer& framebuffer, GLenum format, GLbitfield what)
{
    GLuint renderbuffer = 0, target = 0;
    GLint bound = 0;
    glGetIntegerv(GL_RENDERBUFFER_BINDING_EXT, &bound);
    gl.glGenRenderbuffers(1, &renderbuffer);
    gl.glGenFramebuffers(1, &target);
    gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, renderbuffer);
    gl.glRenderbufferStorage(GL_RENDERBUFFER_EXT, format, 1, 1);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, target);
    gl.glFramebufferRenderbuffer(GL_FRAMEBUFFER_EXT,
                                 hasStencil(format) ? GLenum(GL_DEPTH_STENCIL_ATTACHMENT)
                                                    : GLenum(GL_DEPTH_ATTACHMENT_EXT),
                                 GL_RENDERBUFFER_EXT, renderbuffer);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, framebuffer.draw);
    discardErrors();
    bool done = gl.glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER_EXT) == GL_FRAMEBUFFER_COMPLETE_EXT;
    if (done) gl.glBlitFramebuffer(0, 0, 1, 1, 0, 0, 1, 1, what, GL_NEAREST);
    done = glGetError() == GL_NO_ERROR && done;
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, framebuffer.draw);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, framebuffer.read);
    gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, static_cast<GLuint>(bound));
    gl.glDeleteFramebuffers(1, &target);
    gl.glDeleteRenderbuffers(1, &renderbuffer);
    return done;
}

GLenum colorAttachment(std::size_t i)
{
    return GL_COLOR_ATTACHMENT0_EXT + static_cast<GLenum>(i);
}

// Where an attachment lies, and in what.
struct Attachment
{
    GLint type = GL_NONE, name = 0, level = 0, layer = 0, cubeFace = 0;
};

Attachment askAttachment(const ContextResources& resources, GLenum attachment)
{
    const auto get = [&](GLenum parameter) { return ask(resources, attachment, parameter); };
    Attachment result;
    result.type = get(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE_EXT);
    if (result.type != GL_NONE) result.name = get(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME_EXT);
    if (result.type != GL_TEXTURE) return result;
    result.level = get(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL_EXT);
    result.layer = get(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_3D_ZOFFSET_EXT);
    result.cubeFace = get(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_CUBE_MAP_FACE_EXT);
    return result;
}

// To the framebuffer bound for drawing.
void attachBack(osg::GLExtensions& gl, GLenum attachment, const Attachment& what)
{
    const GLuint name = static_cast<GLuint>(what.name);
    if (what.type == GL_RENDERBUFFER_EXT) {
        gl.glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER_EXT, attachment, GL_RENDERBUFFER_EXT,
                                     name);
    } else if (what.layer > 0) {
        gl.glFramebufferTextureLayer(GL_DRAW_FRAMEBUFFER_EXT, attachment, name, what.level,
                                     what.layer);
    } else {
        const GLenum target =
            what.cubeFace ? static_cast<GLenum>(what.cubeFace) : GLenum(GL_TEXTURE_2D);
        gl.glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER_EXT, attachment, target, name, what.level);
    }
}

} // namespace

Framebuffer queryFramebuffer(const ContextResources& resources)
{
    Framebuffer result;
    GLint name = 0, samples = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING_EXT, &name);
    result.draw = static_cast<GLuint>(name);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING_EXT, &name);
    result.read = static_cast<GLuint>(name);
    glGetIntegerv(GL_SAMPLE_BUFFERS, &samples);
    result.multisampled = samples > 0;
    result.drawBuffers = queryDrawBuffers();
    const bool window = result.draw == 0;
    if (!result.drawBuffers.empty() && result.drawBuffers.front() != GL_NONE) {
        const GLenum first = result.drawBuffers.front();
        result.colorBits = ask(resources, window ? attachmentOf(first) : first,
                               GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE);
    }
    const GLenum depth = window ? GLenum(GL_DEPTH) : GLenum(GL_DEPTH_ATTACHMENT_EXT);
    const GLenum stencil = window ? GLenum(GL_STENCIL) : GLenum(GL_STENCIL_ATTACHMENT_EXT);
    result.depthBits = ask(resources, depth, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE);
    result.stencilBits = ask(resources, stencil, GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE);
    result.floatDepth = result.depthBits > 0 &&
                        ask(resources, depth, ATTACHMENT_COMPONENT_TYPE) == FLOAT_COMPONENTS;
    return result;
}

GLenum findBlitFormat(osg::GLExtensions& gl, const ContextResources& resources,
                      const Framebuffer& framebuffer, GLbitfield what)
{
    for (GLenum format : candidates(gl, resources, framebuffer, what))
        if (canBlit(gl, framebuffer, format, what)) return format;
    return GL_NONE;
}

bool hasStencil(GLenum depthFormat)
{
    return depthFormat == GL_DEPTH24_STENCIL8_EXT || depthFormat == GL_DEPTH32F_STENCIL8;
}

std::vector<GLenum> shareAttachments(osg::GLExtensions& gl, const ContextResources& resources,
                                     const Framebuffer& framebuffer, GLuint target)
{
    std::vector<Attachment> others;
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, framebuffer.draw);
    for (std::size_t i = 1; i < framebuffer.drawBuffers.size(); ++i)
        others.push_back(framebuffer.drawBuffers[i] == GL_NONE
                             ? Attachment()
                             : askAttachment(resources, framebuffer.drawBuffers[i]));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, target);
    std::vector<GLenum> drawBuffers = {colorAttachment(0)};
    discardErrors();
    for (const Attachment& other : others) {
        const GLenum attachment = colorAttachment(drawBuffers.size());
        if (other.type != GL_NONE) attachBack(gl, attachment, other);
        drawBuffers.push_back(other.type != GL_NONE ? attachment : GLenum(GL_NONE));
    }
    gl.glDrawBuffers(static_cast<GLsizei>(drawBuffers.size()), drawBuffers.data());
    if (glGetError() == GL_NO_ERROR &&
        gl.glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER_EXT) == GL_FRAMEBUFFER_COMPLETE_EXT)
        return drawBuffers;
    unshareAttachments(gl, target, drawBuffers.size());
    return {colorAttachment(0)};
}

void unshareAttachments(osg::GLExtensions& gl, GLuint target, std::size_t drawBufferCount)
{
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, target);
    for (std::size_t i = 1; i < drawBufferCount; ++i)
        gl.glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER_EXT, colorAttachment(i), GL_TEXTURE_2D, 0, 0);
    const GLenum first = colorAttachment(0);
    gl.glDrawBuffers(1, &first);
}

FirstDrawBufferScope::FirstDrawBufferScope(osg::GLExtensions& gl,
                                           const std::vector<GLenum>& drawBuffers)
    : _gl(gl), _drawBuffers(drawBuffers)
{
    if (_drawBuffers.size() < 2) return;
    _gl.glDrawBuffers(1, _drawBuffers.data());
    // Mesa asks only when blending changes whether blending of two sources fits the draw buffers.
    if (!glIsEnabled(GL_BLEND)) return;
    glDisable(GL_BLEND);
    glEnable(GL_BLEND);
}

FirstDrawBufferScope::~FirstDrawBufferScope()
{
    if (_drawBuffers.size() > 1)
        _gl.glDrawBuffers(static_cast<GLsizei>(_drawBuffers.size()), _drawBuffers.data());
}

ReadBufferScope::ReadBufferScope(GLenum buffer)
{
    glGetIntegerv(GL_READ_BUFFER, &_before);
    glReadBuffer(buffer);
}

ReadBufferScope::~ReadBufferScope()
{
    glReadBuffer(static_cast<GLenum>(_before));
}

} // namespace render
} // namespace osgVolumizer
