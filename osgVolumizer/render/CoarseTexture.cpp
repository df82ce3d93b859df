#include "CoarseTexture.h"

#include "ReportOnce.h"

#include "../core/voxels/VoxelData.h"

#include <osg/Image>
#include <osg/UserDataContainer>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

std::mutex& coarseMutex()
{
    static std::mutex mutex;
    return mutex;
}

// Calls act with each coarser texture that a brick's keeps.
template <class Act>
void forEachCoarse(osg::Texture3D& brick, Act act)
{
    std::lock_guard<std::mutex> lock(coarseMutex());
    osg::UserDataContainer* kept = brick.getUserDataContainer();
    for (unsigned i = 0; kept && i < kept->getNumUserObjects(); ++i)
        if (auto* texture = dynamic_cast<osg::Texture3D*>(kept->getUserObject(i))) act(*texture);
}

glm::ivec3 sizeOf(const osg::Texture3D& texture)
{
    return {texture.getTextureWidth(), texture.getTextureHeight(), texture.getTextureDepth()};
}

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

osg::ref_ptr<osg::Texture3D> makeCoarse(const osg::Texture3D& brick, const osg::Image& image,
                                        const glm::ivec3& size, const glm::ivec3& newSize)
{
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
    osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D(brick);
    texture->setImage(coarse);
    texture->setInternalFormat(components == 1 ? GL_R32F : GL_RGBA32F_ARB);
    texture->setTextureSize(newSize.x, newSize.y, newSize.z);
    return texture;
}

} // namespace

CoarseTexture fittingTexture(osg::Texture3D& brick, int largest)
{
    const osg::Image& image = *brick.getImage();
    const glm::ivec3 size(image.s(), image.t(), image.r());
    CoarseTexture result;
    if (std::max({size.x, size.y, size.z}) <= largest) {
        result.texture = &brick;
        return result;
    }
    const glm::ivec3 newSize = glm::min(size, glm::ivec3(largest));
    forEachCoarse(brick, [&](osg::Texture3D& texture) {
        if (sizeOf(texture) == newSize) result.texture = &texture;
    });
    if (!result.texture) {
        result.texture = makeCoarse(brick, image, size, newSize);
        std::lock_guard<std::mutex> lock(coarseMutex());
        brick.getOrCreateUserDataContainer()->addUserObject(result.texture);
    }
    const auto text = [](const glm::ivec3& s) {
        return std::to_string(s.x) + "," + std::to_string(s.y) + "," + std::to_string(s.z);
    };
    reportOnce({ErrorCode::NOT_SUPPORTED,
                "a brick of " + text(size) +
                    " voxels is larger than the context's 3D textures, of " +
                    std::to_string(largest) + "; it is drawn from " + text(newSize) +
                    " samples (a smaller Voxels::setBrickSize() keeps them all)"});
    const glm::vec3 n(size), m(newSize);
    const glm::vec3 step = (n - 1.0f) / glm::max(m - 1.0f, 1.0f);
    // A side of one sample has no distance between them.
    const glm::vec3 ratio = glm::mix(step, glm::vec3(1.0f), glm::equal(step, glm::vec3(0.0f)));
    result.scale = n / (ratio * m);
    result.offset = (0.5f - 0.5f / ratio) / m;
    return result;
}

void resizeCoarseTextures(osg::Texture3D& brick, unsigned maximum)
{
    forEachCoarse(brick, [&](osg::Texture3D& texture) { texture.resizeGLObjectBuffers(maximum); });
}

void releaseCoarseTextures(osg::Texture3D& brick, osg::State* state)
{
    forEachCoarse(brick, [&](osg::Texture3D& texture) { texture.releaseGLObjects(state); });
}

} // namespace render
} // namespace osgVolumizer
