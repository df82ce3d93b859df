#pragma once

#include "ContextLimits.h"

#include <osg/GLExtensions>
#include <osg/State>

#include <map>
#include <memory>
#include <typeindex>

namespace osgVolumizer {
namespace render {

/// A GL buffer of one context that vertices or indices are streamed through.
class StreamBuffer
{
public:
    /// Binds the buffer to `target` and fills it.
    void stream(osg::GLExtensions& gl, GLenum target, const void* data, std::size_t bytes);
    void release(osg::GLExtensions& gl);

private:
    GLuint _name = 0;
};

/// GL objects of one context that belong together. Whoever uses them defines a class of its own.
class ContextPart
{
public:
    virtual ~ContextPart() = default;
    /// Deletes bare GL names; the context is current. Textures and programs are OSG's, and go with
    /// their last reference.
    virtual void release(osg::GLExtensions& gl) = 0;
};

/// What the renderer keeps per context, made when first needed.
struct ContextResources
{
    explicit ContextResources(osg::State& state);

    ContextLimits limits;
    using GetAttachmentParameter = void(GL_APIENTRY*)(GLenum, GLenum, GLenum, GLint*);
    GetAttachmentParameter glGetFramebufferAttachmentParameteriv = nullptr; ///< not one of OSG's
    StreamBuffer vertices, indices;

    /// The part of a class, made when it is first asked for. Call in the draw thread.
    template <class Part>
    Part& part()
    {
        std::unique_ptr<ContextPart>& entry = _parts[std::type_index(typeid(Part))];
        if (!entry) entry = std::make_unique<Part>();
        return static_cast<Part&>(*entry);
    }
    /// Deletes the names of all; the context is current.
    void release(osg::GLExtensions& gl);

private:
    std::map<std::type_index, std::unique_ptr<ContextPart>> _parts;
};

/// The resources of the current context; call only while it is current. They are released with the
/// context, when OSG deletes or discards its objects.
std::shared_ptr<ContextResources> contextResources(osg::State& state);
/// How precise a context is, as far as it is known yet: in any thread.
Precision precisionOf(const osg::State& state);
/// That of the least precise context that there is; as of an unknown one where there is none.
Precision leastPrecision();
/// Of how many contexts there are resources.
std::size_t contextResourcesCount();
/// Follows osg::Object::releaseGLObjects: one context's resources, or all for null.
void releaseContextResources(osg::State* state);

} // namespace render
} // namespace osgVolumizer
