#include "Allocation.h"

#include "ContextHooks.h"
#include "GLErrors.h"
#include "ProgramInterface.h"

#include <osg/BufferObject>
#include <osg/ContextData>
#include <osg/Image>

#include <glm/common.hpp>

#include <functional>

namespace osgVolumizer {
namespace render {

namespace {

AllocationRequest requestOf(AllocationRequest::Kind kind, const osg::Texture& texture)
{
    AllocationRequest request;
    request.kind = kind;
    request.internalFormat = static_cast<GLenum>(texture.getInternalFormat());
    request.size = {texture.getTextureWidth(), texture.getTextureHeight(),
                    texture.getTextureDepth()};
    if (const osg::Image* image = texture.getImage(0))
        request.size = {image->s(), image->t(), image->r()};
    request.size = glm::max(request.size, glm::ivec3(1));
    return request;
}

// Nothing that OSG would take for a texture stays.
void forget(osg::State& state, osg::Texture& texture)
{
    const unsigned context = state.getContextID();
    if (auto* object = texture.getTextureObject(context)) {
        object->_allocated = false; // or the next texture of this size gets it as a whole one
        texture.releaseGLObjects(&state);
    }
    if (osg::Image* image = texture.getImage(0))
        if (osg::BufferObject* buffer = image->getBufferObject()) buffer->releaseGLObjects(&state);
}

// Calls what makes a texture's storage in the current context, and returns whether the card gave
// it: cards refuse by a GL error, which is taken off, so that it is nobody else's. Errors of before
// are taken off too.
bool allocate(const osg::State& state, const AllocationRequest& request,
              const std::function<void()>& make)
{
    const ContextHooks* hooks = ContextHooks::of(state);
    if (hooks && hooks->refuses && hooks->refuses(request)) return false;
    // OSG gives a new texture the object of a deleted one that it has not got round to delete,
    // whose storage may be immutable: then GL refuses to make it again.
    osg::get<osg::TextureObjectManager>(state.getContextID())->flushAllDeletedGLObjects();
    discardErrors();
    make();
    const bool made = glGetError() == GL_NO_ERROR;
    discardErrors();
    return made;
}

} // namespace

bool allocateTarget(osg::State& state, osg::Texture& texture, const glm::ivec3& size)
{
    AllocationRequest request;
    request.size = size;
    request.internalFormat = static_cast<GLenum>(texture.getInternalFormat());
    const bool made = allocate(state, request, [&]() {
        // Every brick applies its texture to this unit before it is drawn.
        state.setActiveTextureUnit(UNIT_VOXELS);
        texture.apply(state);
        state.haveAppliedTextureAttribute(UNIT_VOXELS, osg::StateAttribute::TEXTURE);
    });
    if (!made) forget(state, texture);
    return made;
}

bool applyAllocated(osg::State& state, AllocationRequest::Kind kind, osg::Texture& texture,
                    unsigned unit)
{
    if (texture.getTextureObject(state.getContextID())) {
        state.applyTextureAttribute(unit, &texture);
        return true;
    }
    const bool made = allocate(state, requestOf(kind, texture), [&]() {
        state.setActiveTextureUnit(unit);
        texture.apply(state);
    });
    if (made) {
        state.haveAppliedTextureAttribute(unit, &texture);
        return true;
    }
    forget(state, texture);
    state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
    return false;
}

} // namespace render
} // namespace osgVolumizer
