#include "BrickResidency.h"

#include "../context/RenderDataAccess.h"
#include "Texels.h"

#include "../../core/voxels/VoxelData.h"

#include <vector>

namespace osgVolumizer {
namespace render {

osg::ref_ptr<BrickResidency> BrickResidency::of(const Voxels& voxels)
{
    return renderData<BrickResidency>(voxels);
}

VoxelBlock BrickResidency::load(const Voxels& voxels, std::int64_t brick)
{
    return voxels.getBrick(brick);
}

osg::ref_ptr<const osg::Image> BrickResidency::texels(const Voxels& voxels, std::int64_t brick,
                                                      bool gradients)
{
    const VoxelBlock block = load(voxels, brick);
    if (!block) return nullptr;
    return makeTexels(voxels, block, voxels.getLayout().brick(brick).samples.size(), gradients);
}

std::optional<std::vector<core::Box3i>> BrickResidency::changes(const Voxels& voxels,
                                                                std::int64_t brick, bool gradients,
                                                                unsigned modifiedCount)
{
    const core::Box3i samples = voxels.getLayout().brick(brick).samples;
    auto boxes = voxels.getChanges(modifiedCount, samples);
    if (boxes && gradients) boxes = core::coveringBoxes(core::grown(*boxes, 1, samples));
    return boxes;
}

TexelBox BrickResidency::texels(const Voxels& voxels, std::int64_t brick, bool gradients,
                                const core::Box3i& box)
{
    // Differences of the samples around the box, as all of the brick would have them.
    const core::Box3i samples = voxels.getLayout().brick(brick).samples;
    const core::Box3i needed =
        gradients ? intersection(core::Box3i{box.min - 1, box.max + 1}, samples) : box;
    const Result<VoxelBlock> block = voxels.readSamples(needed);
    if (block.ok()) return {makeTexels(voxels, *block, needed.size(), gradients), needed.min};
    reportError(block.status);
    return {};
}

osg::ref_ptr<BrickTexture> BrickResidency::ask(const Voxels& voxels, const BrickRequest& request)
{
    const std::int64_t brick = request.brick;
    const Key key{brick, request.gradients};
    const unsigned modified = voxels.getModifiedCount(brick), layout = voxels.getLayoutCount();
    const auto answer = [&request](const Entry& entry) {
        if (entry.texture) entry.texture->setUse(request.frame, request.priority);
        return entry.texture;
    };
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _entries.find(key);
        if (found != _entries.end() && found->second.modifiedCount == modified &&
            found->second.layoutCount == layout)
            return answer(found->second);
        if (found != _entries.end() && found->second.texture &&
            found->second.layoutCount == layout &&
            voxels.getChanges(found->second.modifiedCount,
                              voxels.getLayout().brick(brick).samples)) {
            found->second.modifiedCount = modified; // its texture is updated when it is drawn
            return answer(found->second);
        }
    }
    const bool readable = _cells.isScanned(voxels, brick) || load(voxels, brick);
    std::lock_guard<std::mutex> lock(_mutex);
    Entry& entry = _entries[key];
    // Another thread may have been first.
    if (entry.modifiedCount != modified || entry.layoutCount != layout || !entry.texture) {
        entry = {nullptr, modified, layout};
        if (readable)
            entry.texture = new BrickTexture(texelFormat(voxels, request.gradients),
                                             voxels.getLayout().brick(brick).samples.size(),
                                             core::sampleCount(voxels.getLayout().size()));
    }
    return answer(entry);
}

osg::ref_ptr<JoinedTexture> BrickResidency::joined(const Voxels& voxels, bool gradients,
                                                   unsigned frame)
{
    std::lock_guard<std::mutex> lock(_mutex);
    JoinedEntry& entry = _joined[gradients];
    if (!entry.texture || entry.layoutCount != voxels.getLayoutCount())
        entry = {new JoinedTexture(texelFormat(voxels, gradients), voxels.getLayout().size()),
                 voxels.getLayoutCount()};
    entry.texture->setUse(frame, std::numeric_limits<float>::max());
    return entry.texture;
}

bool BrickResidency::isJoined(const Voxels& voxels, bool gradients) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _joined.find(gradients);
    return found != _joined.end() && found->second.layoutCount == voxels.getLayoutCount();
}

osg::ref_ptr<const osg::Image> BrickResidency::texel(const Voxels& voxels, std::int64_t brick,
                                                     bool gradients)
{
    const unsigned modified = voxels.getModifiedCount(brick), layout = voxels.getLayoutCount();
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const TexelEntry& entry = _texels[{brick, gradients}];
        if (entry.image && entry.modifiedCount == modified && entry.layoutCount == layout)
            return entry.image;
    }
    const auto range = voxels.getBrickRange(brick);
    if (!(range.first <= range.second)) return nullptr;
    const osg::ref_ptr<const osg::Image> image = uniformTexel(voxels, range.first, gradients);
    std::lock_guard<std::mutex> lock(_mutex);
    _texels[{brick, gradients}] = {image, modified, layout};
    return image;
}

Residency BrickResidency::residency(const Voxels& voxels, std::int64_t brick, bool gradients,
                                    unsigned contextId) const
{
    const unsigned modified = voxels.getModifiedCount(brick), layout = voxels.getLayoutCount();
    osg::ref_ptr<JoinedTexture> joined;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _entries.find({brick, gradients});
        if (found != _entries.end() && found->second.modifiedCount == modified &&
            found->second.layoutCount == layout) {
            if (!found->second.texture) return Residency::NEVER;
            if (found->second.texture->isIn(contextId)) return Residency::RESIDENT;
        }
        const auto all = _joined.find(gradients);
        if (all != _joined.end() && all->second.layoutCount == layout) joined = all->second.texture;
    }
    return joined && joined->has(contextId, brick, modified) ? Residency::RESIDENT
                                                             : Residency::NOT_YET;
}

unsigned BrickResidency::lastUse(std::int64_t brick, bool gradients) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const osg::ref_ptr<ResidentTexture> texture = textureOf({brick, gradients});
    return texture ? texture->lastFrame() : 0;
}

// Expects the lock.
osg::ref_ptr<ResidentTexture> BrickResidency::textureOf(const Key& key) const
{
    if (key.first == ALL_BRICKS) {
        const auto joined = _joined.find(key.second);
        return joined == _joined.end() ? nullptr : joined->second.texture.get();
    }
    const auto found = _entries.find(key);
    return found == _entries.end() ? nullptr : found->second.texture.get();
}

void BrickResidency::makeRoom(osg::State& state, std::int64_t brick, bool gradients,
                              const ResidentTexture& texture)
{
    std::vector<osg::ref_ptr<ResidentTexture>> others;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        std::set<Key>& uploaded = _uploaded[state.getContextID()];
        uploaded.insert({brick, gradients});
        if (_budget == UNLIMITED) return;
        for (const Key& key : uploaded) {
            const osg::ref_ptr<ResidentTexture> other = textureOf(key);
            if (other && other != &texture) others.push_back(other);
        }
    }
    keepWithin(_budget - texture.bytes(), others, state);
}

std::int64_t BrickResidency::bytes(unsigned contextId) const
{
    std::int64_t sum = 0;
    std::vector<osg::ref_ptr<JoinedTexture>> joined;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& entry : _entries)
            if (entry.second.texture && entry.second.texture->isIn(contextId))
                sum += entry.second.texture->bytes();
        for (const auto& entry : _joined)
            joined.push_back(entry.second.texture);
    }
    for (const auto& texture : joined)
        if (texture->isIn(contextId)) sum += texture->bytes();
    return sum;
}

std::shared_ptr<Pages> BrickResidency::pages(const Voxels& voxels)
{
    std::shared_ptr<Pages> pages;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        if (!_pages) _pages = Pages::create();
        pages = _pages;
    }
    pages->begin(voxels);
    return pages;
}

void BrickResidency::resizeGLObjectBuffers(unsigned int maximum)
{
    _cells.resizeGLObjectBuffers(maximum);
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto& entry : _entries)
        if (entry.second.texture) entry.second.texture->resizeGLObjectBuffers(maximum);
    for (auto& entry : _joined)
        entry.second.texture->resizeGLObjectBuffers(maximum);
    if (_pages) _pages->resizeGLObjectBuffers(maximum);
}

void BrickResidency::releaseGLObjects(osg::State* state) const
{
    _cells.releaseGLObjects(state);
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _entries)
        if (entry.second.texture) entry.second.texture->releaseGLObjects(state);
    for (const auto& entry : _joined)
        entry.second.texture->releaseGLObjects(state);
    if (_pages) _pages->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
