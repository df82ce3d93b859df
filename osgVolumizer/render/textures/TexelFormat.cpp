#include "TexelFormat.h"

#include "../../core/voxels/Half.h"
#include "../../core/voxels/VoxelData.h"

#include <osg/GLExtensions>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace osgVolumizer {
namespace render {

namespace {

// llvmpipe filters floats fastest. Other formats take its path of 8-bit arithmetic, whose results
// are off by half a 255th, only where all axes repeat or clamp to the edge; one that is mirrored,
// which is the same up to a texel beyond the edge, makes it filter in floats whatever is stored: as
// exact, and a quarter slower. So small volumes are stored as floats, and large ones as they are.
constexpr std::int64_t FLOAT_BYTES = std::int64_t(64) << 20;

// Keeps the samples alive for as long as an image refers to them.
class BlockHolder : public osg::Referenced
{
public:
    explicit BlockHolder(std::shared_ptr<const void> block) : _block(std::move(block)) {}

private:
    std::shared_ptr<const void> _block;
};

TexelFormat formatOf(VoxelType type, int components)
{
    const bool scalar = components == 1;
    switch (type) {
    case VoxelType::UINT8:
    case VoxelType::INT8:
        return {VoxelType::UINT8, GLenum(scalar ? GL_R8 : GL_RGBA8), GL_UNSIGNED_BYTE, false};
    case VoxelType::UINT16:
    case VoxelType::INT16:
        return {VoxelType::UINT16, GLenum(scalar ? GL_R16 : GL_RGBA16), GL_UNSIGNED_SHORT, false};
    case VoxelType::HALF:
        return {VoxelType::HALF, GLenum(scalar ? GL_R16F : GL_RGBA16F_ARB), GL_HALF_FLOAT, false};
    case VoxelType::FLOAT32:
        return {VoxelType::FLOAT32, GLenum(scalar ? GL_R32F : GL_RGBA32F_ARB), GL_FLOAT, false};
    default:
        return {VoxelType::FLOAT32, GLenum(scalar ? GL_R32F : GL_RGBA32F_ARB), GL_FLOAT, true};
    }
}

// Smallest value of a signed type, which its texels are counted from.
double signedOffset(VoxelType type)
{
    return type == VoxelType::INT8 ? -128.0 : type == VoxelType::INT16 ? -32768.0 : 0.0;
}

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
    const double offset = format.fraction ? -range.x() * scale : -signedOffset(type);
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

// What the format of scalars becomes with their gradients.
TexelFormat gradientFormat(const TexelFormat& scalars)
{
    if (scalars.type == VoxelType::UINT8 || scalars.type == VoxelType::UINT16)
        return {VoxelType::UINT16, GL_RGBA16, GL_UNSIGNED_SHORT, false};
    return {VoxelType::FLOAT32, GL_RGBA32F_ARB, GL_FLOAT, scalars.fraction};
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

bool TexelFormat::isScalar() const
{
    return internalFormat == GL_R8 || internalFormat == GL_R16 || internalFormat == GL_R16F ||
           internalFormat == GL_R32F;
}

std::int64_t TexelFormat::texelBytes() const
{
    return static_cast<std::int64_t>(voxelTypeSize(type)) * (isScalar() ? 1 : 4);
}

TexelFormat texelFormat(const Voxels& voxels, bool gradients)
{
    const TexelFormat format = formatOf(voxels.getType(), voxels.getComponents());
    return gradients ? gradientFormat(format) : format;
}

osg::ref_ptr<osg::Image> makeTexels(const Voxels& voxels, const VoxelBlock& block,
                                    const glm::ivec3& size, bool gradients)
{
    const TexelFormat samples = formatOf(voxels.getType(), voxels.getComponents());
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

osg::ref_ptr<osg::Texture3D> makeVoxelTexture(const TexelFormat& format, const glm::ivec3& size,
                                              std::int64_t volumeTexels,
                                              const ContextLimits& limits)
{
    const std::int64_t floatBytes = format.isScalar() ? 4 : 16;
    osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D;
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    for (auto axis : {osg::Texture::WRAP_S, osg::Texture::WRAP_T, osg::Texture::WRAP_R})
        texture->setWrap(axis, osg::Texture::CLAMP_TO_EDGE);
    texture->setDataVariance(osg::Object::STATIC);
    texture->setTextureSize(size.x, size.y, size.z);
    texture->setSourceFormat(format.isScalar() ? GL_RED : GL_RGBA);
    texture->setSourceType(format.dataType);
    GLenum internalFormat = format.internalFormat;
    if (limits.filtersFloatsBest) {
        if (volumeTexels <= FLOAT_BYTES / floatBytes)
            internalFormat = format.isScalar() ? GLenum(GL_R32F) : GLenum(GL_RGBA32F_ARB);
        else
            texture->setWrap(osg::Texture::WRAP_R, osg::Texture::MIRROR);
    }
    texture->setInternalFormat(static_cast<GLint>(internalFormat));
    return texture;
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

glm::dvec2 texelToRangeFraction(const Voxels& voxels)
{
    const TexelFormat format = formatOf(voxels.getType(), voxels.getComponents());
    if (format.fraction) return {1.0, 0.0};
    const osg::Vec2d range = voxels.getRange();
    const double unit = format.type == VoxelType::UINT8    ? 255.0
                        : format.type == VoxelType::UINT16 ? 65535.0
                                                           : 1.0;
    const double width = range.y() - range.x();
    return {unit / width, (signedOffset(voxels.getType()) - range.x()) / width};
}

glm::vec2 gradientDecode(const Voxels& voxels)
{
    const VoxelType type = formatOf(voxels.getType(), 1).type;
    const bool integer = type == VoxelType::UINT8 || type == VoxelType::UINT16;
    return integer ? glm::vec2(2.0f, -1.0f) : glm::vec2(1.0f, 0.0f);
}

} // namespace render
} // namespace osgVolumizer
