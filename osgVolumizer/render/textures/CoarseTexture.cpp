#include "CoarseTexture.h"

#include "../../core/voxels/VoxelData.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

VoxelType voxelTypeOf(GLenum dataType)
{
    switch (dataType) {
    case GL_UNSIGNED_BYTE:
        return VoxelType::UINT8;
    case GL_UNSIGNED_SHORT:
        return VoxelType::UINT16;
    case GL_HALF_FLOAT:
        return VoxelType::HALF;
    default:
        return VoxelType::FLOAT32;
    }
}

// Texels as the shader reads them.
std::vector<float> texelsOf(const osg::Image& image)
{
    const VoxelType type = voxelTypeOf(image.getDataType());
    const double unit = type == VoxelType::UINT8    ? 255.0
                        : type == VoxelType::UINT16 ? 65535.0
                                                    : 1.0;
    std::vector<float> texels(std::size_t(image.s()) * image.t() * image.r() *
                              osg::Image::computeNumComponents(image.getPixelFormat()));
    core::convertVoxels(image.data(), type, texels.data(), VoxelType::FLOAT32, texels.size(),
                        1.0 / unit);
    return texels;
}

// Linear interpolation along one axis: `count` rows of `stride` values, to `newCount` rows, the
// first and the last in place.
std::vector<float> resample(const std::vector<float>& in, std::size_t stride, int count,
                            int newCount)
{
    if (newCount == count) return in;
    const std::size_t blocks = in.size() / (stride * static_cast<std::size_t>(count));
    std::vector<float> out(blocks * stride * static_cast<std::size_t>(newCount));
    const double ratio = (count - 1.0) / (newCount - 1.0);
    for (std::size_t block = 0; block < blocks; ++block)
        for (int i = 0; i < newCount; ++i) {
            const int low = std::min(static_cast<int>(i * ratio), count - 2);
            const float weight = static_cast<float>(i * ratio - low);
            const float* a = &in[(block * static_cast<std::size_t>(count) + low) * stride];
            const float* b = a + stride;
            float* to = &out[(block * static_cast<std::size_t>(newCount) + i) * stride];
            for (std::size_t k = 0; k < stride; ++k)
                to[k] = a[k] + weight * (b[k] - a[k]);
        }
    return out;
}

} // namespace

osg::ref_ptr<osg::Image> coarserTexels(const osg::Image& image, const glm::ivec3& newSize)
{
    const glm::ivec3 size(image.s(), image.t(), image.r());
    const std::size_t components = osg::Image::computeNumComponents(image.getPixelFormat());
    std::vector<float> texels = texelsOf(image);
    std::size_t stride = components;
    for (int axis = 0; axis < 3; ++axis) {
        texels = resample(texels, stride, size[axis], newSize[axis]);
        stride *= static_cast<std::size_t>(newSize[axis]);
    }
    osg::ref_ptr<osg::Image> coarse = new osg::Image;
    coarse->allocateImage(newSize.x, newSize.y, newSize.z, image.getPixelFormat(), GL_FLOAT);
    std::copy(texels.begin(), texels.end(), reinterpret_cast<float*>(coarse->data()));
    return coarse;
}

CoarseTexture coarseTexture(osg::Texture3D& texture, const glm::ivec3& brickSize)
{
    CoarseTexture result;
    result.texture = &texture;
    const glm::ivec3 newSize(texture.getTextureWidth(), texture.getTextureHeight(),
                             texture.getTextureDepth());
    if (newSize == brickSize) return result;
    const glm::vec3 n(brickSize), m(newSize);
    const glm::vec3 step = (n - 1.0f) / glm::max(m - 1.0f, 1.0f);
    // A side of one sample has no distance between them.
    const glm::vec3 ratio = glm::mix(step, glm::vec3(1.0f), glm::equal(step, glm::vec3(0.0f)));
    result.scale = n / (ratio * m);
    result.offset = (0.5f - 0.5f / ratio) / m;
    return result;
}

} // namespace render
} // namespace osgVolumizer
