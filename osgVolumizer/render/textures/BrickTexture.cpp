#include "BrickTexture.h"

#include "../context/Allocation.h"
#include "../context/ReportOnce.h"
#include "../context/Statistics.h"
#include "Texels.h"

#include "../../core/Text.h"
#include "../../core/voxels/VoxelData.h"

#include <glm/common.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

constexpr int SMALLEST = 2; // side of a texture that is drawn from

int largestSide(const glm::ivec3& size)
{
    return std::max({size.x, size.y, size.z});
}

void reportCoarser(const glm::ivec3& size, const glm::ivec3& newSize, int texture3DSize)
{
    const std::string brick = "a brick of " + core::formatTriple(size) + " voxels ";
    const std::string way = "; it is drawn from " + core::formatTriple(newSize) +
                            " samples (a smaller Voxels::setBrickSize() keeps them all)";
    if (largestSide(size) > texture3DSize)
        reportOnce({ErrorCode::NOT_SUPPORTED, brick +
                                                  "is larger than the context's 3D textures, of " +
                                                  std::to_string(texture3DSize) + way});
    else
        reportOnce({ErrorCode::TOO_LARGE, brick + "is refused by the graphics card" + way});
}

} // namespace

std::int64_t BrickTexture::bytes() const
{
    return core::sampleCount(_size) * _format.texelBytes();
}

std::shared_ptr<BrickTexture::Copy> BrickTexture::copyIn(unsigned contextId)
{
    std::lock_guard<std::mutex> lock(_mutex);
    std::shared_ptr<Copy>& copy = _copies[contextId];
    if (!copy) copy = std::make_shared<Copy>();
    return copy;
}

bool BrickTexture::isIn(unsigned contextId) const
{
    std::shared_ptr<Copy> copy;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _copies.find(contextId);
        if (found == _copies.end()) return false;
        copy = found->second;
    }
    std::lock_guard<std::mutex> lock(copy->mutex);
    return copy->texture && copy->texture->getTextureObject(contextId);
}

bool BrickTexture::isAnywhere() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& copy : _copies) {
        std::lock_guard<std::mutex> copyLock(copy.second->mutex);
        if (copy.second->texture && copy.second->texture->getTextureObject(copy.first)) return true;
    }
    return false;
}

CoarseTexture BrickTexture::apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                                  const Load& load, unsigned unit, const BrickChanges* changes)
{
    osg::State& state = *renderInfo.getState();
    const std::shared_ptr<Copy> copy = copyIn(state.getContextID());
    const auto applyMade = [&]() {
        if (!copy->texture || !copy->texture->getTextureObject(state.getContextID())) return false;
        state.applyTextureAttribute(unit, copy->texture.get());
        return true;
    };
    {
        std::lock_guard<std::mutex> lock(copy->mutex);
        if (copy->refused) return {};
        const bool current = !changes || copy->modifiedCount == changes->modifiedCount;
        if (applyMade() && current) return coarseTexture(*copy->texture, _size);
    }
    if (changes && update(renderInfo, *changes, *copy, unit)) {
        std::lock_guard<std::mutex> lock(copy->mutex);
        if (copy->texture) return coarseTexture(*copy->texture, _size);
    }
    const osg::ref_ptr<const osg::Image> texels = load();
    if (!texels) return {};
    std::lock_guard<std::mutex> lock(copy->mutex);
    const bool current = !changes || copy->modifiedCount == changes->modifiedCount;
    if (!applyMade() || !current) make(renderInfo, limits, *texels, *copy, unit);
    if (changes) copy->modifiedCount = changes->modifiedCount;
    return copy->texture ? coarseTexture(*copy->texture, _size) : CoarseTexture();
}

// Writes what has changed; false where all has to be written. Texels are loaded without the lock.
bool BrickTexture::update(osg::RenderInfo& renderInfo, const BrickChanges& changes, Copy& copy,
                          unsigned unit) const
{
    osg::State& state = *renderInfo.getState();
    unsigned modifiedCount = 0;
    {
        std::lock_guard<std::mutex> lock(copy.mutex);
        if (!copy.texture || !copy.texture->getTextureObject(state.getContextID()) ||
            copy.texture->getTextureWidth() != _size.x ||
            copy.texture->getTextureHeight() != _size.y ||
            copy.texture->getTextureDepth() != _size.z)
            return false;
        modifiedCount = copy.modifiedCount;
    }
    const auto boxes = changes.since(modifiedCount);
    if (!boxes) return false;
    std::vector<TexelBox> texels;
    for (const core::Box3i& box : *boxes) {
        texels.push_back(changes.load(box));
        if (!texels.back().image) return false;
    }
    std::lock_guard<std::mutex> lock(copy.mutex);
    if (!copy.texture || copy.modifiedCount != modifiedCount) return false;
    state.applyTextureAttribute(unit, copy.texture.get());
    state.setActiveTextureUnit(unit);
    state.unbindPixelBufferObject();
    double count = 0.0;
    for (std::size_t i = 0; i < boxes->size(); ++i) {
        const core::Box3i& box = (*boxes)[i];
        writeTexels(state, *texels[i].image, box.min - texels[i].origin, box.min - changes.origin,
                    box.size());
        count += double(core::sampleCount(box.size()));
    }
    if (count > 0.0) countUploaded(renderInfo, 1.0, count, count * double(_format.texelBytes()));
    copy.modifiedCount = changes.modifiedCount;
    return true;
}

void BrickTexture::make(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                        const osg::Image& texels, Copy& copy, unsigned unit) const
{
    osg::State& state = *renderInfo.getState();
    for (int side = std::min(limits.texture3DSize, largestSide(_size));
         side >= SMALLEST || side == largestSide(_size); side /= 2) {
        const glm::ivec3 size = glm::min(_size, glm::ivec3(side));
        TexelFormat format = _format;
        osg::ref_ptr<const osg::Image> own(&texels);
        if (size != _size) {
            own = coarserTexels(texels, size);
            format.type = VoxelType::FLOAT32;
            format.internalFormat = format.isScalar() ? GLenum(GL_R32F) : GLenum(GL_RGBA32F_ARB);
            format.dataType = GL_FLOAT;
        }
        copy.texture = makeVoxelTexture(format, size, _volumeTexels, limits);
        state.unbindPixelBufferObject();
        if (applyAllocated(state, AllocationRequest::BRICK, *copy.texture, unit)) {
            writeTexels(state, *own, glm::ivec3(0), glm::ivec3(0), size);
            countUploaded(renderInfo, 1.0, double(core::sampleCount(_size)),
                          static_cast<double>(bytes()));
            if (size != _size) reportCoarser(_size, size, limits.texture3DSize);
            return;
        }
    }
    copy.texture = nullptr;
    copy.refused = true;
    reportOnce({ErrorCode::TOO_LARGE, "a brick of " + core::formatTriple(_size) +
                                          " voxels is refused by the graphics card, and coarser "
                                          "ones of it; it is not drawn"});
}

void BrickTexture::resizeGLObjectBuffers(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto& copy : _copies) {
        std::lock_guard<std::mutex> copyLock(copy.second->mutex);
        if (copy.second->texture) copy.second->texture->resizeGLObjectBuffers(maximum);
    }
}

void BrickTexture::releaseGLObjects(osg::State* state)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto& copy : _copies) {
        if (state && copy.first != state->getContextID()) continue;
        std::lock_guard<std::mutex> copyLock(copy.second->mutex);
        if (copy.second->texture) copy.second->texture->releaseGLObjects(state);
        copy.second->texture = nullptr;
        copy.second->refused = false;
    }
}

void countUploaded(osg::RenderInfo& renderInfo, double bricks, double texels, double bytes)
{
    const osg::FrameStamp* stamp = renderInfo.getState()->getFrameStamp();
    count(renderInfo.getCurrentCamera(), stamp, "osgVolumizer bricks uploaded", bricks);
    count(renderInfo.getCurrentCamera(), stamp, "osgVolumizer voxels uploaded", texels);
    count(renderInfo.getCurrentCamera(), stamp, "osgVolumizer bytes uploaded", bytes);
}

} // namespace render
} // namespace osgVolumizer
