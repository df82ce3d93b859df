#pragma once

#include <osg/State>
#include <osg/Texture>

#include <glm/vec3.hpp>

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
        TABLE,
        TETRAHEDRA
    };
    Kind kind = TARGET;
    glm::ivec3 size{1}; ///< texels
    GLenum internalFormat = 0;
};

/// Makes the storage of a texture without an image, which is of the kind TARGET; false where the
/// card refuses it. Leaves the texture bound to a unit that OSG knows to have changed. Takes GL's
/// error off, and those of before.
bool allocateTarget(osg::State& state, osg::Texture& texture, const glm::ivec3& size);

/// Applies a texture with size and format, or with an image, to a unit, as
/// State::applyTextureAttribute() does. Where the context lacks it, it is made, and checked; false
/// where the card refuses it: then the context has no object of it.
bool applyAllocated(osg::State& state, AllocationRequest::Kind kind, osg::Texture& texture,
                    unsigned unit);

} // namespace render
} // namespace osgVolumizer
