#pragma once

#include "ContextResources.h"

#include <osg/Texture2D>
#include <osg/Texture2DArray>

#include <glm/vec3.hpp>

namespace osgVolumizer {
namespace render {

/// What buffers that are drawn into instead of the framebuffer are made from. These functions leave
/// bindings of framebuffers undefined. Call them in the draw thread.

/// A texture to draw into, of one level; null where the card has no memory for it: see
/// Allocation.h.
osg::ref_ptr<osg::Texture2D> makeTarget(osg::State& state, int width, int height,
                                        GLenum internalFormat);
/// Likewise an array of size.z textures.
osg::ref_ptr<osg::Texture2DArray> makeTargetArray(osg::State& state, const glm::ivec3& size,
                                                  GLenum internalFormat);

/// A 32-bit float target of colour, grown to the largest size that was asked for.
struct FloatTarget
{
    int width = 0, height = 0;
    GLuint framebuffer = 0;
    osg::ref_ptr<osg::Texture2D> color;

    /// Makes it, or makes it anew where it is too small; false where the card has no memory for it.
    bool ensure(osg::State& state, int minimumWidth, int minimumHeight);
};

/// The name of a texture that was made.
GLuint textureName(const osg::State& state, const osg::Texture& texture);

/// Binds a framebuffer object, which is made where its name is 0.
void bindOwn(osg::GLExtensions& gl, GLuint& framebuffer);
/// Attaches a texture to the framebuffer bound.
void attach(osg::GLExtensions& gl, GLenum attachment, GLuint texture);
/// Attaches a depth texture, and its stencil values if it has any, to the framebuffer bound.
void attachDepth(osg::GLExtensions& gl, GLuint texture, GLenum depthFormat);
/// Binds a framebuffer that has a depth texture only.
void bindDepthOnly(osg::State& state, GLuint& framebuffer, const osg::Texture& depth,
                   GLenum depthFormat);
/// Deletes framebuffer objects, and sets their names to 0.
void deleteFramebuffers(osg::GLExtensions& gl, std::initializer_list<GLuint*> names);

} // namespace render
} // namespace osgVolumizer
