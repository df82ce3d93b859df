#include "BrickTextures.h"

#include "Statistics.h"

#include "../core/voxels/Half.h"
#include "../core/voxels/VoxelData.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

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

// How a voxel type goes to GL: signed integers are moved up to unsigned ones, and what has no
// filterable texture becomes the fraction of the range as a float.
struct TexelFormat
{
    VoxelType type;
    GLenum internalFormat, dataType;
    bool fraction; ///< texels are fractions of the voxels' range
};

TexelFormat texelFormat(VoxelType type, int components)
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

// Scalars of any type with their gradients, and the format that they then have.
VoxelBlock withGradients(const VoxelBlock& block, const glm::ivec3& size, TexelFormat& format)
{
    switch (format.type) {
    case VoxelType::UINT8:
        format = {VoxelType::UINT16, GL_RGBA16, GL_UNSIGNED_SHORT, false};
        return withGradients<std::uint8_t, std::uint16_t>(block, size);
    case VoxelType::UINT16:
        format = {VoxelType::UINT16, GL_RGBA16, GL_UNSIGNED_SHORT, false};
        return withGradients<std::uint16_t, std::uint16_t>(block, size);
    case VoxelType::HALF:
        format = {VoxelType::FLOAT32, GL_RGBA32F_ARB, GL_FLOAT, false};
        return withGradients<core::Half, float>(block, size);
    default:
        format = {VoxelType::FLOAT32, GL_RGBA32F_ARB, GL_FLOAT, format.fraction};
        return withGradients<float, float>(block, size);
    }
}

// What samples become in a texture.
osg::ref_ptr<osg::Image> makeImage(const Voxels& voxels, VoxelBlock block, const glm::ivec3& size,
                                   bool gradients)
{
    TexelFormat format = texelFormat(voxels.getType(), voxels.getComponents());
    block = texelsOf(voxels, block, format);
    if (gradients) block = withGradients(block, size, format);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setImage(size.x, size.y, size.z, static_cast<GLint>(format.internalFormat),
                    voxels.getComponents() == 1 && !gradients ? GL_RED : GL_RGBA, format.dataType,
                    const_cast<unsigned char*>(block.data), osg::Image::NO_DELETE, 1);
    image->setUserData(new BlockHolder(block.owner));
    return image;
}

osg::ref_ptr<osg::Texture3D> linearTexture()
{
    osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D;
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setUnRefImageDataAfterApply(false);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    for (auto axis : {osg::Texture::WRAP_S, osg::Texture::WRAP_T, osg::Texture::WRAP_R})
        texture->setWrap(axis, osg::Texture::CLAMP_TO_EDGE);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
}

BrickTexture makeTexture(const Voxels& voxels, std::int64_t brick, bool gradients)
{
    const VoxelBlock block = voxels.getBrick(brick);
    if (!block.data) return {};
    const glm::ivec3 size = voxels.getLayout().brick(brick).samples.size();
    const osg::ref_ptr<osg::Image> image = makeImage(voxels, block, size, gradients);
    const osg::ref_ptr<osg::Texture3D> texture = linearTexture();
    texture->setImage(image);
    texture->setInternalFormat(image->getInternalTextureFormat());
    return {texture, image->getTotalSizeInBytes()};
}

} // namespace

void suitFormat(osg::Texture3D& texture, const ContextLimits& limits)
{
    if (!limits.filtersFloatsBest) return;
    switch (texture.getInternalFormat()) {
    case GL_R8:
    case GL_R16:
    case GL_R16F:
        texture.setInternalFormat(GL_R32F);
        break;
    case GL_RGBA8:
    case GL_RGBA16:
    case GL_RGBA16F_ARB:
        texture.setInternalFormat(GL_RGBA32F_ARB);
        break;
    default:
        break;
    }
}

osg::ref_ptr<BrickTextures> BrickTextures::of(const Voxels& voxels)
{
    const auto data = voxels.getOrCreateRenderData(
        []() -> osg::ref_ptr<Voxels::RenderData> { return new BrickTextures; });
    return static_cast<BrickTextures*>(data.get());
}

BrickTexture BrickTextures::get(const Voxels& voxels, std::int64_t brick, bool gradients)
{
    const unsigned modified = voxels.getModifiedCount(brick), layout = voxels.getLayoutCount();
    std::lock_guard<std::mutex> lock(_mutex);
    Entry& entry = _entries[{brick, gradients}];
    if (!entry.brick.texture || entry.modifiedCount != modified || entry.layoutCount != layout)
        entry = {makeTexture(voxels, brick, gradients), modified, layout};
    return entry.brick;
}

osg::ref_ptr<JoinedTexture> BrickTextures::joined(const Voxels& voxels, const osg::Image& like,
                                                  bool gradients)
{
    std::lock_guard<std::mutex> lock(_mutex);
    JoinedEntry& entry = _joined[gradients];
    if (!entry.texture || entry.layoutCount != voxels.getLayoutCount())
        entry = {new JoinedTexture(linearTexture(), voxels.getSize(), like),
                 voxels.getLayoutCount()};
    return entry.texture;
}

bool BrickTextures::isJoined(const Voxels& voxels, bool gradients) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _joined.find(gradients);
    return found != _joined.end() && found->second.layoutCount == voxels.getLayoutCount();
}

osg::ref_ptr<const osg::Image> BrickTextures::texel(const Voxels& voxels, std::int64_t brick,
                                                    bool gradients)
{
    const unsigned modified = voxels.getModifiedCount(brick), layout = voxels.getLayoutCount();
    std::lock_guard<std::mutex> lock(_mutex);
    TexelEntry& entry = _texels[{brick, gradients}];
    if (entry.image && entry.modifiedCount == modified && entry.layoutCount == layout)
        return entry.image;
    const auto range = voxels.getBrickRange(brick);
    if (!(range.first <= range.second)) return nullptr;
    const std::vector<double> values(static_cast<std::size_t>(voxels.getComponents()), range.first);
    auto texel = std::make_shared<std::vector<unsigned char>>(values.size() *
                                                              voxelTypeSize(voxels.getType()));
    core::convertVoxels(values.data(), VoxelType::FLOAT64, texel->data(), voxels.getType(),
                        values.size());
    entry = {makeImage(voxels, {texel, texel->data(), texel->size()}, glm::ivec3(1), gradients),
             modified, layout};
    return entry.image;
}

void BrickTextures::resizeGLObjectBuffers(unsigned int maximum)
{
    _cells.resizeGLObjectBuffers(maximum);
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto& entry : _entries)
        if (entry.second.brick.texture) {
            entry.second.brick.texture->resizeGLObjectBuffers(maximum);
            resizeCoarseTextures(*entry.second.brick.texture, maximum);
        }
    for (auto& entry : _joined)
        entry.second.texture->texture()->resizeGLObjectBuffers(maximum);
}

void BrickTextures::releaseGLObjects(osg::State* state) const
{
    _cells.releaseGLObjects(state);
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _entries)
        if (entry.second.brick.texture) {
            entry.second.brick.texture->releaseGLObjects(state);
            releaseCoarseTextures(*entry.second.brick.texture, state);
        }
    for (const auto& entry : _joined)
        entry.second.texture->texture()->releaseGLObjects(state);
}

void countUploaded(osg::RenderInfo& renderInfo, double bricks, double bytes)
{
    const osg::FrameStamp* stamp = renderInfo.getState()->getFrameStamp();
    count(renderInfo.getCurrentCamera(), stamp, "osgVolumizer bricks uploaded", bricks);
    count(renderInfo.getCurrentCamera(), stamp, "osgVolumizer bytes uploaded", bytes);
}

CoarseTexture applyBrick(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                         const BrickTexture& brick, unsigned unit)
{
    osg::State& state = *renderInfo.getState();
    const CoarseTexture fitting = fittingTexture(*brick.texture, limits.texture3DSize);
    if (!fitting.texture->getTextureObject(state.getContextID())) {
        countUploaded(renderInfo, 1.0, static_cast<double>(brick.bytes));
        suitFormat(*fitting.texture, limits);
    }
    state.applyTextureAttribute(unit, fitting.texture.get());
    return fitting;
}

glm::dvec2 texelToRangeFraction(const Voxels& voxels)
{
    const TexelFormat format = texelFormat(voxels.getType(), voxels.getComponents());
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
    const VoxelType type = texelFormat(voxels.getType(), 1).type;
    const bool integer = type == VoxelType::UINT8 || type == VoxelType::UINT16;
    return integer ? glm::vec2(2.0f, -1.0f) : glm::vec2(1.0f, 0.0f);
}

} // namespace render
} // namespace osgVolumizer
