#include "Texels.h"

#include "TexelFormat.h"

#include "../../core/voxels/Half.h"
#include "../../core/voxels/VoxelData.h"

#include <osg/GLExtensions>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

// Keeps the samples alive for as long as an image refers to them.
class BlockHolder : public osg::Referenced
{
public:
    explicit BlockHolder(std::shared_ptr<const void> block) : _block(std::move(block)) {}

private:
    std::shared_ptr<const void> _block;
};

// NaN and infinite values.
bool isHole(float v)
{
    return !std::isfinite(v);
}
bool isHole(std::uint16_t half)
{
    return (half & 0x7c00u) == 0x7c00u;
}

template <class T>
bool hasHoles(const unsigned char* data, std::size_t count)
{
    const auto* values = reinterpret_cast<const T*>(data);
    return std::any_of(values, values + count, [](T v) { return isHole(v); });
}

// Holes show what the lowest value shows; a NaN would spread through the filter.
template <class T>
void fillHoles(unsigned char* data, std::size_t count, T lowest)
{
    auto* values = reinterpret_cast<T*>(data);
    std::replace_if(
        values, values + count, [](T v) { return isHole(v); }, lowest);
}

// The texels of a brick: the block itself where nothing has to change.
VoxelBlock texelsOf(const Voxels& voxels, const VoxelBlock& block, const TexelFormat& format)
{
    const VoxelType type = voxels.getType();
    const std::size_t count = block.bytes / voxelTypeSize(type);
    const bool same = type == format.type && !format.fraction;
    const bool floats = format.type == VoxelType::FLOAT32, halves = format.type == VoxelType::HALF;
    if (same && !(floats && hasHoles<float>(block.data, count)) &&
        !(halves && hasHoles<std::uint16_t>(block.data, count)))
        return block;
    const osg::Vec2d range = voxels.getRange();
    const double scale = format.fraction ? 1.0 / (range.y() - range.x()) : 1.0;
    const double offset = format.fraction ? -range.x() * scale : -lowestSigned(type);
    auto converted =
        std::make_shared<std::vector<unsigned char>>(count * voxelTypeSize(format.type));
    core::convertVoxels(block.data, type, converted->data(), format.type, count, scale, offset);
    const float lowest = format.fraction ? 0.0f : static_cast<float>(range.x());
    if (floats) fillHoles<float>(converted->data(), count, lowest);
    if (halves) {
        std::uint16_t lowestHalf = 0;
        core::convertVoxels(&lowest, VoxelType::FLOAT32, &lowestHalf, VoxelType::HALF, 1);
        fillHoles<std::uint16_t>(converted->data(), count, lowestHalf);
    }
    return {converted, converted->data(), converted->size()};
}

// Value and central differences, less at the last samples, of texels that are floats or unsigned
// integers. Integers stay integers: values and half of differences, moved up, as 16 bits.
template <class T, class Out>
VoxelBlock withGradients(const VoxelBlock& block, const glm::ivec3& size)
{
    constexpr bool integer = std::is_integral<T>::value;
    constexpr double unit = integer ? double(std::numeric_limits<T>::max()) : 1.0;
    const auto* in = reinterpret_cast<const T*>(block.data);
    auto texels = std::make_shared<std::vector<Out>>();
    texels->reserve(4 * block.bytes / sizeof(T));
    const std::int64_t stride[3] = {1, size.x, std::int64_t(size.x) * size.y};
    const T* value = in;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x, ++value) {
                const int at[3] = {x, y, z};
                for (int a = 0; a < 3; ++a) {
                    const int low = at[a] > 0 ? 1 : 0, high = at[a] + 1 < size[a] ? 1 : 0;
                    const double difference =
                        (double(value[high * stride[a]]) - double(value[-low * stride[a]])) /
                        std::max(low + high, 1);
                    texels->push_back(static_cast<Out>(
                        integer ? std::lround((0.5 * difference / unit + 0.5) * 65535.0)
                                : difference));
                }
                texels->push_back(
                    static_cast<Out>(integer ? double(*value) / unit * 65535.0 : double(*value)));
            }
    return {texels, reinterpret_cast<unsigned char*>(texels->data()), texels->size() * sizeof(Out)};
}

VoxelBlock withGradients(const VoxelBlock& block, const glm::ivec3& size, VoxelType type)
{
    switch (type) {
    case VoxelType::UINT8:
        return withGradients<std::uint8_t, std::uint16_t>(block, size);
    case VoxelType::UINT16:
        return withGradients<std::uint16_t, std::uint16_t>(block, size);
    case VoxelType::HALF:
        return withGradients<core::Half, float>(block, size);
    default:
        return withGradients<float, float>(block, size);
    }
}

} // namespace

osg::ref_ptr<osg::Image> makeTexels(const Voxels& voxels, const VoxelBlock& block,
                                    const glm::ivec3& size, bool gradients)
{
    const TexelFormat samples = texelFormat(voxels, false);
    const TexelFormat format = texelFormat(voxels, gradients);
    VoxelBlock texels = texelsOf(voxels, block, samples);
    if (gradients) texels = withGradients(texels, size, samples.type);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setImage(size.x, size.y, size.z, static_cast<GLint>(format.internalFormat),
                    format.isScalar() ? GL_RED : GL_RGBA, format.dataType,
                    const_cast<unsigned char*>(texels.data), osg::Image::NO_DELETE, 1);
    image->setUserData(new BlockHolder(texels.owner));
    return image;
}

osg::ref_ptr<osg::Image> uniformTexel(const Voxels& voxels, double value, bool gradients)
{
    const std::vector<double> values(static_cast<std::size_t>(voxels.getComponents()), value);
    auto texel = std::make_shared<std::vector<unsigned char>>(values.size() *
                                                              voxelTypeSize(voxels.getType()));
    core::convertVoxels(values.data(), VoxelType::FLOAT64, texel->data(), voxels.getType(),
                        values.size());
    return makeTexels(voxels, {texel, texel->data(), texel->size()}, glm::ivec3(1), gradients);
}

void writeTexels(osg::State& state, const osg::Image& texels, const glm::ivec3& first,
                 const glm::ivec3& at, const glm::ivec3& size)
{
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, texels.s());
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, texels.t());
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, first.x);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, first.y);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, first.z);
    state.get<osg::GLExtensions>()->glTexSubImage3D(GL_TEXTURE_3D, 0, at.x, at.y, at.z, size.x,
                                                    size.y, size.z, texels.getPixelFormat(),
                                                    texels.getDataType(), texels.data());
    for (GLenum name : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_PIXELS,
                        GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES})
        glPixelStorei(name, 0);
}

} // namespace render
} // namespace osgVolumizer
