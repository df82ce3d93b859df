#include "JoinedTexture.h"

#include "../context/Allocation.h"
#include "../context/ReportOnce.h"
#include "BrickTexture.h"
#include "Texels.h"

#include "../../core/Text.h"
#include "../../core/voxels/ChangeLog.h"
#include "../../core/voxels/VoxelData.h"

#include <osg/GLExtensions>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace osgVolumizer {
namespace render {

namespace {

std::size_t texelBytes(const osg::Image& image)
{
    return image.getPixelSizeInBits() / 8;
}

// An image of as many copies of another's one texel.
osg::ref_ptr<osg::Image> repeated(const osg::Image& texel, const glm::ivec3& size)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size.x, size.y, size.z, texel.getPixelFormat(), texel.getDataType(), 1);
    const std::size_t bytes = texelBytes(texel), all = image->getTotalSizeInBytes();
    for (std::size_t i = 0; i < all; i += bytes)
        std::memcpy(image->data() + i, texel.data(), bytes);
    return image;
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

bool JoinedTexture::Contents::lacks(const JoinedPiece& piece) const
{
    const auto found = bricks.find(piece.brick);
    return found == bricks.end() || found->second.modifiedCount != piece.modifiedCount ||
           (found->second.empty && !piece.emptyTexel);
}

std::optional<unsigned> JoinedTexture::Contents::written(const JoinedPiece& piece) const
{
    const auto found = bricks.find(piece.brick);
    if (found == bricks.end() || found->second.empty || !(found->second.samples == piece.samples))
        return std::nullopt;
    return found->second.modifiedCount;
}

std::shared_ptr<JoinedTexture::Contents> JoinedTexture::find(unsigned contextId) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _contents.find(contextId);
    return found == _contents.end() ? nullptr : found->second;
}

std::shared_ptr<JoinedTexture::Contents> JoinedTexture::contentsIn(unsigned contextId)
{
    std::lock_guard<std::mutex> lock(_mutex);
    std::shared_ptr<Contents>& contents = _contents[contextId];
    if (!contents) contents = std::make_shared<Contents>();
    return contents;
}

bool JoinedTexture::isRefused(unsigned contextId) const
{
    const std::shared_ptr<Contents> contents = find(contextId);
    return contents && contents->refused;
}

bool JoinedTexture::isIn(unsigned contextId) const
{
    const std::shared_ptr<Contents> contents = find(contextId);
    if (!contents) return false;
    std::lock_guard<std::mutex> lock(contents->mutex);
    return contents->texture && contents->texture->getTextureObject(contextId);
}

bool JoinedTexture::has(unsigned contextId, std::int64_t brick, unsigned modifiedCount) const
{
    const std::shared_ptr<Contents> contents = find(contextId);
    if (!contents) return false;
    std::lock_guard<std::mutex> lock(contents->mutex);
    if (!contents->texture || !contents->texture->getTextureObject(contextId)) return false;
    const auto found = contents->bricks.find(brick);
    return found != contents->bricks.end() && found->second.modifiedCount == modifiedCount;
}

std::int64_t JoinedTexture::bytes() const
{
    return core::sampleCount(_size) * _format.texelBytes();
}

bool JoinedTexture::make(osg::State& state, const ContextLimits& limits, Contents& contents,
                         unsigned unit) const
{
    contents.bricks.clear();
    contents.texture = makeVoxelTexture(_format, _size, core::sampleCount(_size), limits);
    contents.refused =
        !applyAllocated(state, AllocationRequest::JOINED_BRICKS, *contents.texture, unit);
    if (!contents.refused) {
        clear(state, *contents.texture);
        return true;
    }
    contents.texture = nullptr;
    reportOnce({ErrorCode::TOO_LARGE, "one texture for a volume of " + core::formatTriple(_size) +
                                          " voxels is refused by the graphics card; its bricks "
                                          "have textures of their own"});
    return false;
}

void JoinedTexture::writeEmpty(osg::State& state, const JoinedPiece& piece, Contents& contents)
{
    for (auto other = contents.bricks.begin(); other != contents.bricks.end();) {
        const bool overwritten =
            !other->second.empty && !intersection(other->second.samples, piece.samples).empty();
        other = overwritten ? contents.bricks.erase(other) : std::next(other);
    }
    const glm::ivec3 size = piece.samples.size();
    writeTexels(state, *repeated(*piece.emptyTexel, size), glm::ivec3(0), piece.samples.min, size);
    contents.bricks[piece.brick] = {piece.modifiedCount, true, piece.samples};
}

// Applies the texture, and writes the empty pieces; gives those whose texels have to be loaded.
bool JoinedTexture::prepare(osg::State& state, const ContextLimits& limits,
                            const std::vector<JoinedPiece>& pieces, const Changes& changes,
                            Contents& contents, unsigned unit,
                            std::vector<const JoinedPiece*>& lacking) const
{
    std::lock_guard<std::mutex> lock(contents.mutex);
    if (contents.refused) return false;
    state.unbindPixelBufferObject();
    if (!contents.texture || !contents.texture->getTextureObject(state.getContextID())) {
        if (!make(state, limits, contents, unit)) return false;
    } else {
        state.applyTextureAttribute(unit, contents.texture.get());
    }
    const auto lacks = [&contents](const JoinedPiece& piece) { return contents.lacks(piece); };
    if (std::none_of(pieces.begin(), pieces.end(), lacks)) return true;
    state.setActiveTextureUnit(unit);
    // Empty bricks first, since they share samples with others, which are then written again.
    // One that has all its texels, of which some have changed, stays: its neighbours do not matter.
    const auto isKnown = [&](const JoinedPiece& piece) {
        const auto count = contents.written(piece);
        return count && changes.since(piece.brick, *count);
    };
    for (const JoinedPiece& piece : pieces)
        if (piece.emptyTexel && lacks(piece) && !isKnown(piece)) writeEmpty(state, piece, contents);
    for (const JoinedPiece& piece : pieces)
        if (lacks(piece)) lacking.push_back(&piece);
    return true;
}

// False where the texture has been released meanwhile.
bool JoinedTexture::write(osg::State& state, const JoinedPiece& piece, const osg::Image& texels,
                          Contents& contents)
{
    std::lock_guard<std::mutex> lock(contents.mutex);
    if (!contents.texture || !contents.texture->getTextureObject(state.getContextID()))
        return false;
    writeTexels(state, texels, piece.samples.min - piece.texelsOrigin, piece.samples.min,
                piece.samples.size());
    contents.bricks[piece.brick] = {piece.modifiedCount, false, piece.samples};
    return true;
}

// Writes what of a piece has changed; false where all of it has to be written.
bool JoinedTexture::update(osg::RenderInfo& renderInfo, const JoinedPiece& piece,
                           const Changes& changes, Contents& contents) const
{
    osg::State& state = *renderInfo.getState();
    std::optional<unsigned> before;
    {
        std::lock_guard<std::mutex> lock(contents.mutex);
        before = contents.written(piece);
    }
    const auto boxes =
        before ? changes.since(piece.brick, *before) : std::optional<std::vector<core::Box3i>>();
    if (!boxes) return false;
    const std::vector<core::Box3i> parts = core::clipped(*boxes, piece.samples);
    std::vector<TexelBox> texels; // loaded without the lock
    for (const core::Box3i& part : parts) {
        texels.push_back(changes.load(piece.brick, part));
        if (!texels.back().image) return false;
    }
    std::lock_guard<std::mutex> lock(contents.mutex);
    if (!contents.texture || contents.written(piece) != before) return false;
    double count = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        writeTexels(state, *texels[i].image, parts[i].min - texels[i].origin, parts[i].min,
                    parts[i].size());
        count += double(core::sampleCount(parts[i].size()));
    }
    if (count > 0.0) countUploaded(renderInfo, 1.0, count, count * double(_format.texelBytes()));
    contents.bricks[piece.brick].modifiedCount = piece.modifiedCount;
    return true;
}

bool JoinedTexture::apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                          const std::vector<JoinedPiece>& pieces, const Load& load,
                          const Changes& changes, unsigned unit)
{
    osg::State& state = *renderInfo.getState();
    const std::shared_ptr<Contents> contents = contentsIn(state.getContextID());
    std::vector<const JoinedPiece*> lacking;
    if (!prepare(state, limits, pieces, changes, *contents, unit, lacking)) return false;
    double bricks = 0.0, count = 0.0, bytes = 0.0;
    for (const JoinedPiece* piece : lacking) {
        if (update(renderInfo, *piece, changes, *contents)) continue;
        const osg::ref_ptr<const osg::Image> texels = load(piece->brick);
        if (!texels) continue;
        if (!write(state, *piece, *texels, *contents)) break;
        bricks += 1.0;
        count += double(texels->s()) * texels->t() * texels->r();
        bytes += double(texelBytes(*texels)) * texels->s() * texels->t() * texels->r();
    }
    if (bricks > 0.0) countUploaded(renderInfo, bricks, count, bytes);
    return true;
}

std::vector<std::pair<unsigned, std::shared_ptr<JoinedTexture::Contents>>>
JoinedTexture::allContents() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return {_contents.begin(), _contents.end()};
}

void JoinedTexture::resizeGLObjectBuffers(unsigned int maximum)
{
    for (const auto& contents : allContents()) {
        std::lock_guard<std::mutex> lock(contents.second->mutex);
        if (contents.second->texture) contents.second->texture->resizeGLObjectBuffers(maximum);
    }
}

void JoinedTexture::releaseGLObjects(osg::State* state)
{
    for (const auto& contents : allContents()) {
        if (state && contents.first != state->getContextID()) continue;
        std::lock_guard<std::mutex> lock(contents.second->mutex);
        if (contents.second->texture) contents.second->texture->releaseGLObjects(state);
        contents.second->texture = nullptr;
        contents.second->bricks.clear();
        contents.second->refused = false;
    }
}

} // namespace render
} // namespace osgVolumizer
