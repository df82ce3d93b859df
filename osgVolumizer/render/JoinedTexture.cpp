#include "JoinedTexture.h"

#include "BrickTextures.h"

#include <osg/GLExtensions>

#include <algorithm>
#include <cstring>

namespace osgVolumizer {
namespace render {

namespace {

std::size_t texelBytes(const osg::Image& image)
{
    return image.getPixelSizeInBits() / 8;
}

// As many copies of the image's one texel.
std::vector<unsigned char> repeated(const osg::Image& image, const glm::ivec3& size)
{
    const std::size_t bytes = texelBytes(image);
    std::vector<unsigned char> texels(bytes * size.x * size.y * size.z);
    for (std::size_t i = 0; i < texels.size(); i += bytes)
        std::memcpy(&texels[i], image.data(), bytes);
    return texels;
}

// Texels that no brick has written yet are next to others, and a filter may read them with a weight
// of nothing: they must be numbers.
void clear(osg::State& state, const osg::Texture3D& texture)
{
    const int w = texture.getTextureWidth(), h = texture.getTextureHeight(),
              depth = texture.getTextureDepth();
    const std::size_t layer =
        std::size_t(w) * h *
        osg::Image::computePixelSizeInBits(texture.getSourceFormat(), texture.getSourceType()) / 8;
    constexpr std::size_t CHUNK = 16 << 20;
    const int layers = std::clamp(static_cast<int>(CHUNK / layer), 1, depth);
    const std::vector<unsigned char> zeros(layer * std::size_t(layers));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int z = 0; z < depth; z += layers)
        state.get<osg::GLExtensions>()->glTexSubImage3D(
            GL_TEXTURE_3D, 0, 0, 0, z, w, h, std::min(layers, depth - z), texture.getSourceFormat(),
            texture.getSourceType(), zeros.data());
}

} // namespace

JoinedTexture::JoinedTexture(osg::Texture3D* texture, const glm::ivec3& size,
                             const osg::Image& like)
    : _texture(texture)
{
    _texture->setTextureSize(size.x, size.y, size.z);
    _texture->setInternalFormat(like.getInternalTextureFormat());
    _texture->setSourceFormat(like.getPixelFormat());
    _texture->setSourceType(like.getDataType());
}

void JoinedTexture::write(osg::State& state, const JoinedPiece& piece, Contents& contents)
{
    const osg::Image& image = *piece.texels;
    const glm::ivec3 at = piece.samples.min, size = piece.samples.size();
    const glm::ivec3 skipped = at - piece.imageOrigin;
    std::vector<unsigned char> filled;
    const void* texels = image.data();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (piece.empty) {
        filled = repeated(image, size);
        texels = filled.data();
    } else {
        glPixelStorei(GL_UNPACK_ROW_LENGTH, image.s());
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, image.t());
        glPixelStorei(GL_UNPACK_SKIP_PIXELS, skipped.x);
        glPixelStorei(GL_UNPACK_SKIP_ROWS, skipped.y);
        glPixelStorei(GL_UNPACK_SKIP_IMAGES, skipped.z);
    }
    state.get<osg::GLExtensions>()->glTexSubImage3D(GL_TEXTURE_3D, 0, at.x, at.y, at.z, size.x,
                                                    size.y, size.z, image.getPixelFormat(),
                                                    image.getDataType(), texels);
    for (GLenum name : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_PIXELS,
                        GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES})
        glPixelStorei(name, 0);
    contents[piece.brick] = {piece.modifiedCount, piece.empty, piece.samples};
}

void JoinedTexture::apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                          const std::vector<JoinedPiece>& pieces, unsigned unit)
{
    osg::State& state = *renderInfo.getState();
    std::lock_guard<std::mutex> lock(_mutex);
    Contents& contents = _contents[state.getContextID()];
    const bool fresh = !_texture->getTextureObject(state.getContextID());
    if (fresh) {
        contents.clear();
        suitFormat(*_texture, limits);
    }
    const auto lacks = [&contents](const JoinedPiece& piece) {
        const auto found = contents.find(piece.brick);
        return found == contents.end() || found->second.modifiedCount != piece.modifiedCount ||
               (found->second.empty && !piece.empty);
    };
    if (std::none_of(pieces.begin(), pieces.end(), lacks)) {
        state.applyTextureAttribute(unit, _texture.get());
        return;
    }
    state.setActiveTextureUnit(unit);
    state.unbindPixelBufferObject();
    _texture->apply(state);
    state.haveAppliedTextureAttribute(unit, _texture.get());
    if (fresh) clear(state, *_texture);
    // Empty bricks first, since they share samples with others, which are then written again.
    for (const JoinedPiece& piece : pieces) {
        if (!piece.empty || !lacks(piece)) continue;
        for (auto other = contents.begin(); other != contents.end();) {
            const bool overwritten =
                !other->second.empty && !intersection(other->second.samples, piece.samples).empty();
            other = overwritten ? contents.erase(other) : std::next(other);
        }
        write(state, piece, contents);
    }
    double bricks = 0.0, bytes = 0.0;
    for (const JoinedPiece& piece : pieces) {
        if (piece.empty || !lacks(piece)) continue;
        write(state, piece, contents);
        bricks += 1.0;
        bytes += double(texelBytes(*piece.texels)) * piece.texels->s() * piece.texels->t() *
                 piece.texels->r();
    }
    if (bricks > 0.0) countUploaded(renderInfo, bricks, bytes);
}

} // namespace render
} // namespace osgVolumizer
