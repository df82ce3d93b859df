#include "SampleCache.h"

#include <algorithm>
#include <utility>

namespace osgVolumizer {
namespace picking {

namespace {

/// Of what the source has in memory there is no second copy.
bool sharesMemory(const Voxels& voxels, const core::Box3i& samples, const VoxelBlock& block)
{
    try {
        return voxels.getSource()->share(samples).data == block.data;
    } catch (...) {
        return false; // a user's source may throw
    }
}

std::shared_ptr<SampleChunk> readChunk(const Voxels& voxels, std::int64_t index, int step)
{
    const bool paged = voxels.isPaged();
    const core::Box3i samples =
        paged ? voxels.getTree().brick(index).samples : voxels.getLayout().brick(index).samples;
    const VoxelBlock block = paged ? voxels.readPage(index, step).value : voxels.getBrick(index);
    const int components = voxels.getComponents();
    const core::VoxelView view{block.data, voxels.getType(), components, samples.size()};
    const bool shared = block && !paged && sharesMemory(voxels, samples, block);
    return std::make_shared<SampleChunk>(block, view, samples, components == 4 ? 3 : 0,
                                         voxels.getRange().x(), shared ? 0 : block.bytes);
}

} // namespace

ChunkPtr SampleCache::get(const Voxels& voxels, std::int64_t index, int step)
{
    const Key key{index, step};
    const unsigned layout = voxels.getLayoutCount();
    const unsigned modified =
        voxels.isPaged() ? voxels.getChangeCount() : voxels.getModifiedCount(index);
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _entries.find(key);
        if (found != _entries.end() && found->second.layoutCount == layout &&
            (found->second.modifiedCount == modified ||
             update(voxels, index, modified, found->second))) {
            found->second.used = ++_clock;
            return found->second.chunk;
        }
    }
    const std::shared_ptr<SampleChunk> chunk =
        readChunk(voxels, index, step); // others may pick meanwhile
    // A page that could not be read is asked for again.
    if (!voxels.isPaged() || chunk->wasRead()) keep(key, {chunk, layout, modified, 0});
    return chunk;
}

// Brings what is there up to a count of changes; false where it has to be read. Expects the lock.
bool SampleCache::update(const Voxels& voxels, std::int64_t index, unsigned modified, Entry& entry)
{
    const core::Box3i all =
        voxels.isPaged() ? core::samplesBelow(voxels.getTree(), voxels.getTree().brick(index))
                         : entry.chunk->samples();
    const auto changed = voxels.getChanges(entry.modifiedCount, all);
    if (!changed || (voxels.isPaged() && !changed->empty())) return false;
    if (!changed->empty()) {
        if (entry.chunk.use_count() > 1) return false; // somebody picks with it
        const auto read = [&voxels](const core::Box3i& box) {
            return voxels.readSamples(box).value;
        };
        _bytes -= entry.chunk->ownBytes();
        const bool shared = sharesMemory(voxels, all, entry.chunk->block());
        const bool updated = entry.chunk->update(*changed, shared, read);
        _bytes += entry.chunk->ownBytes();
        if (!updated) return false;
    }
    entry.modifiedCount = modified;
    return true;
}

void SampleCache::keep(const Key& key, Entry entry)
{
    std::lock_guard<std::mutex> lock(_mutex);
    ++_readCount;
    entry.used = ++_clock;
    Entry& place = _entries[key];
    if (place.chunk) _bytes -= place.chunk->ownBytes();
    _bytes += entry.chunk->ownBytes();
    place = std::move(entry);
    while (_bytes > MAXIMUM_BYTES && _entries.size() > 1)
        forgetLeastRecent(key);
}

void SampleCache::forgetLeastRecent(const Key& but)
{
    auto oldest = _entries.end();
    for (auto e = _entries.begin(); e != _entries.end(); ++e)
        if (but < e->first || e->first < but)
            if (oldest == _entries.end() || e->second.used < oldest->second.used) oldest = e;
    _bytes -= oldest->second.chunk->ownBytes();
    _entries.erase(oldest);
}

std::uint64_t SampleCache::readCount() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _readCount;
}

} // namespace picking
} // namespace osgVolumizer
