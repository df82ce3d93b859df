#pragma once

#include <osg/Texture3D>

#include <glm/vec3.hpp>

namespace osgVolumizer {
namespace render {

/// A 3D texture for a context whose textures are smaller than the brick: samples of the brick's
/// trilinear interpolant at equal distances, the outermost ones in place.
struct CoarseTexture
{
    osg::ref_ptr<osg::Texture3D> texture;
    /// Of what texture coordinates of the brick's texture become here.
    glm::vec3 scale{1.0f}, offset{0.0f};
};

/// The brick's texture itself, where it is no larger than `largest` texels a side, else a coarser
/// one, made on the first call and kept by the brick's texture. `largest` >= 2. Thread safe.
CoarseTexture fittingTexture(osg::Texture3D& brick, int largest);
/// Follow osg::Object: the coarser ones of a brick.
void resizeCoarseTextures(osg::Texture3D& brick, unsigned maximum);
void releaseCoarseTextures(osg::Texture3D& brick, osg::State* state);

} // namespace render
} // namespace osgVolumizer
