#pragma once

#include "../../Voxels.h"

#include <osg/Image>
#include <osg/State>

#include <glm/vec3.hpp>

namespace osgVolumizer {
namespace render {

/// What samples become in a texture, as an image that refers to the block where nothing has to
/// change.
osg::ref_ptr<osg::Image> makeTexels(const Voxels& voxels, const VoxelBlock& block,
                                    const glm::ivec3& size, bool gradients);
/// One texel that stands for samples that all have one value.
osg::ref_ptr<osg::Image> uniformTexel(const Voxels& voxels, double value, bool gradients);
/// Texels of a part of a brick.
struct TexelBox
{
    osg::ref_ptr<const osg::Image> image; ///< null where the source fails
    glm::ivec3 origin{0};                 ///< voxel frame; of the image's first texel
};

/// Writes a box of a texture that is bound. \param first of the image's texels that are written
void writeTexels(osg::State& state, const osg::Image& texels, const glm::ivec3& first,
                 const glm::ivec3& at, const glm::ivec3& size);

} // namespace render
} // namespace osgVolumizer
