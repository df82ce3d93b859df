#include "TargetBuffers.h"

#include <algorithm>

#include "Allocation.h"
#include "Framebuffer.h"

namespace osgVolumizer {
namespace render {

namespace {

// How texels of a format would come from memory; they never do.
void setSource(osg::Texture& texture, GLenum internalFormat)
{
    GLenum format = GL_RGBA, type = GL_FLOAT;
    switch (internalFormat) {
    case GL_DEPTH32F_STENCIL8:
        format = GL_DEPTH_STENCIL_EXT;
        type = GL_FLOAT_32_UNSIGNED_INT_24_8_REV;
        break;
    case GL_DEPTH24_STENCIL8_EXT:
        format = GL_DEPTH_STENCIL_EXT;
        type = GL_UNSIGNED_INT_24_8_EXT;
        break;
    case GL_DEPTH_COMPONENT32F:
        format = GL_DEPTH_COMPONENT;
        break;
    case GL_DEPTH_COMPONENT16:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH_COMPONENT32:
        format = GL_DEPTH_COMPONENT;
        type = GL_UNSIGNED_INT;
        break;
    default:
        break;
    }
    texture.setInternalFormat(static_cast<GLint>(internalFormat));
    texture.setSourceFormat(format);
    texture.setSourceType(type);
    texture.setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture.setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture.setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture.setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture.setResizeNonPowerOfTwoHint(false);
    texture.setDataVariance(osg::Object::STATIC);
}

} // namespace

osg::ref_ptr<osg::Texture2D> makeTarget(osg::State& state, int width, int height,
                                        GLenum internalFormat)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(width, height);
    setSource(*texture, internalFormat);
    return allocateTarget(state, *texture, {width, height, 1}) ? texture : nullptr;
}

osg::ref_ptr<osg::Texture2DArray> makeTargetArray(osg::State& state, const glm::ivec3& size,
                                                  GLenum internalFormat)
{
    osg::ref_ptr<osg::Texture2DArray> texture = new osg::Texture2DArray;
    texture->setTextureSize(size.x, size.y, size.z);
    setSource(*texture, internalFormat);
    return allocateTarget(state, *texture, size) ? texture : nullptr;
}

GLuint textureName(const osg::State& state, const osg::Texture& texture)
{
    return texture.getTextureObject(state.getContextID())->id();
}

void bindOwn(osg::GLExtensions& gl, GLuint& framebuffer)
{
    if (!framebuffer) gl.glGenFramebuffers(1, &framebuffer);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, framebuffer);
}

void attach(osg::GLExtensions& gl, GLenum attachment, GLuint texture)
{
    gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, attachment, GL_TEXTURE_2D, texture, 0);
}

void attachDepth(osg::GLExtensions& gl, GLuint texture, GLenum depthFormat)
{
    attach(gl, GL_DEPTH_STENCIL_ATTACHMENT, 0);
    attach(gl,
           hasStencil(depthFormat) ? GLenum(GL_DEPTH_STENCIL_ATTACHMENT)
                                   : GLenum(GL_DEPTH_ATTACHMENT_EXT),
           texture);
}

void bindDepthOnly(osg::State& state, GLuint& framebuffer, const osg::Texture& depth,
                   GLenum depthFormat)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    bindOwn(gl, framebuffer);
    attachDepth(gl, textureName(state, depth), depthFormat);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
}

void deleteFramebuffers(osg::GLExtensions& gl, std::initializer_list<GLuint*> names)
{
    for (GLuint* name : names) {
        if (*name) gl.glDeleteFramebuffers(1, name);
        *name = 0;
    }
}

bool FloatTarget::ensure(osg::State& state, int minimumWidth, int minimumHeight)
{
    if (color && width >= minimumWidth && height >= minimumHeight) return true;
    width = std::max(minimumWidth, width);
    height = std::max(minimumHeight, height);
    color = makeTarget(state, width, height, GL_RGBA32F_ARB);
    if (!color) {
        width = height = 0;
        return false;
    }
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    bindOwn(gl, framebuffer);
    attach(gl, GL_COLOR_ATTACHMENT0_EXT, textureName(state, *color));
    return true;
}

} // namespace render
} // namespace osgVolumizer
