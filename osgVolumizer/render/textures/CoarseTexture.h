#pragma once

#include <osg/Image>
#include <osg/Texture3D>

#include <glm/vec3.hpp>

namespace osgVolumizer {
namespace render {

/// A 3D texture for a brick, perhaps for a context whose textures are smaller than that: then
/// samples of the brick's trilinear interpolant at equal distances, the outermost ones in place.
struct CoarseTexture
{
    osg::ref_ptr<osg::Texture3D> texture; ///< null where the context has none
    /// Of what texture coordinates of the brick become here.
    glm::vec3 scale{1.0f}, offset{0.0f};
};

/// Those samples, as floats; `size` is no larger than the image on any axis.
osg::ref_ptr<osg::Image> coarserTexels(const osg::Image& texels, const glm::ivec3& size);
/// A texture of such samples, or of all of a brick's.
CoarseTexture coarseTexture(osg::Texture3D& texture, const glm::ivec3& brickSize);

} // namespace render
} // namespace osgVolumizer
