#include "TexelFormat.h"

namespace osgVolumizer {
namespace render {

namespace {

// llvmpipe filters floats fastest. Other formats take its path of 8-bit arithmetic, whose results
// are off by half a 255th, only where all axes repeat or clamp to the edge; one that is mirrored,
// which is the same up to a texel beyond the edge, makes it filter in floats whatever is stored: as
// exact, and a quarter slower. So small volumes are stored as floats, and large ones as they are.
constexpr std::int64_t FLOAT_BYTES = std::int64_t(64) << 20;

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

// What the format of scalars becomes with their gradients.
TexelFormat gradientFormat(const TexelFormat& scalars)
{
    if (scalars.type == VoxelType::UINT8 || scalars.type == VoxelType::UINT16)
        return {VoxelType::UINT16, GL_RGBA16, GL_UNSIGNED_SHORT, false};
    return {VoxelType::FLOAT32, GL_RGBA32F_ARB, GL_FLOAT, scalars.fraction};
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

double lowestSigned(VoxelType type)
{
    return type == VoxelType::INT8 ? -128.0 : type == VoxelType::INT16 ? -32768.0 : 0.0;
}

TexelFormat texelFormat(const Voxels& voxels, bool gradients)
{
    const TexelFormat format = formatOf(voxels.getType(), voxels.getComponents());
    return gradients ? gradientFormat(format) : format;
}

std::int64_t floatTexelBytes(const TexelFormat& format)
{
    return format.isScalar() ? 4 : 16;
}

osg::ref_ptr<osg::Texture3D> makeVoxelTexture(const TexelFormat& format, const glm::ivec3& size,
                                              std::int64_t volumeTexels,
                                              const ContextLimits& limits)
{
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
        if (volumeTexels <= FLOAT_BYTES / floatTexelBytes(format))
            internalFormat = format.isScalar() ? GLenum(GL_R32F) : GLenum(GL_RGBA32F_ARB);
        else
            texture->setWrap(osg::Texture::WRAP_R, osg::Texture::MIRROR);
    }
    texture->setInternalFormat(static_cast<GLint>(internalFormat));
    return texture;
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
    return {unit / width, (lowestSigned(voxels.getType()) - range.x()) / width};
}

glm::vec2 gradientDecode(const Voxels& voxels)
{
    const VoxelType type = formatOf(voxels.getType(), 1).type;
    const bool integer = type == VoxelType::UINT8 || type == VoxelType::UINT16;
    return integer ? glm::vec2(2.0f, -1.0f) : glm::vec2(1.0f, 0.0f);
}

} // namespace render
} // namespace osgVolumizer
