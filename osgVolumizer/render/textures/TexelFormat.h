#pragma once

#include "../context/ContextLimits.h"

#include "../../Voxels.h"

#include <osg/Texture3D>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace osgVolumizer {
namespace render {

/// How voxels go to GL: signed integers are moved up to unsigned ones, and what has no filterable
/// texture becomes the fraction of the range as a float.
struct TexelFormat
{
    VoxelType type = VoxelType::FLOAT32; ///< of a component
    GLenum internalFormat = 0, dataType = 0;
    bool fraction = false; ///< texels are fractions of the voxels' range

    bool isScalar() const;
    std::int64_t texelBytes() const;
};

/// `gradients`: central differences in red, green and blue, see gradientDecode(), and the value in
/// alpha.
TexelFormat texelFormat(const Voxels& voxels, bool gradients);
/// Bytes of a texel of that many components as floats, as a context may have them: see
/// ContextLimits::filtersFloatsBest.
std::int64_t floatTexelBytes(const TexelFormat& format);
/// Smallest value of the signed types that are moved up, which their texels are counted from; 0 for
/// others.
double lowestSigned(VoxelType type);

/// A texture of a format and a size without an image, interpolated, as suits a context.
/// \param volumeTexels of all the volume, whose other bricks have textures like this
osg::ref_ptr<osg::Texture3D> makeVoxelTexture(const TexelFormat& format, const glm::ivec3& size,
                                              std::int64_t volumeTexels,
                                              const ContextLimits& limits);

/// Scale and offset from a texel, as the shader reads it, to the fraction of the voxels' range.
glm::dvec2 texelToRangeFraction(const Voxels& voxels);
/// Scale and offset from a texel of a texture with gradients to the difference of texels per voxel.
glm::vec2 gradientDecode(const Voxels& voxels);

} // namespace render
} // namespace osgVolumizer
