#pragma once

#include <osg/State>
#include <osg/Texture>

#include <glm/vec3.hpp>

#include <functional>

namespace osgVolumizer {
namespace render {

/// Memory of the card that is about to be asked for.
struct AllocationRequest
{
    enum Kind
    {
        TARGET, ///< what is drawn into
        JOINED_BRICKS,
        BRICK,
        CELLS,
        TABLE
    };
    Kind kind = TARGET;
    glm::ivec3 size{1}; ///< texels
    GLenum internalFormat = 0;
};

/// Calls what makes a texture's storage in the current context, and returns whether the card gave
/// it: cards refuse by a GL error, which is taken off, so that it is nobody else's. Errors of
/// before are taken off too.
bool allocate(const AllocationRequest& request, const std::function<void()>& make);

/// Makes the storage of a texture without an image, which is of the kind TARGET. Leaves the texture
/// bound to a unit that OSG knows to have changed.
bool allocateTarget(osg::State& state, osg::Texture& texture, const glm::ivec3& size);

/// Applies a texture with size and format, or with an image, to a unit, as
/// State::applyTextureAttribute() does. Where the context lacks it, it is made, and checked; false
/// where the card refuses it: then the context has no object of it.
bool applyAllocated(osg::State& state, AllocationRequest::Kind kind, osg::Texture& texture,
                    unsigned unit);

/// For tests: what cards refuse from now on, besides what they refuse anyhow; an empty function
/// ends it. Thread safe.
void mockAllocation(std::function<bool(const AllocationRequest&)> isRefused);

} // namespace render
} // namespace osgVolumizer
