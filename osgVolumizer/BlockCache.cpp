#include "BlockCache.h"

#include <iterator>

namespace osgVolumizer {

VoxelBlock BlockCache::find(const Key& key)
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _byKey.find(key);
    if (found == _byKey.end()) return {};
    _entries.splice(_entries.begin(), _entries, found->second);
    return found->second->block;
}

void BlockCache::add(const Key& key, const VoxelBlock& block, bool shared)
{
    const std::size_t bytes = shared ? 0 : block.bytes;
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto found = _byKey.find(key); found != _byKey.end()) erase(found->second);
    if (bytes > _maximumBytes) return;
    for (auto last = _entries.end(); _bytes + bytes > _maximumBytes && last != _entries.begin();) {
        const auto entry = std::prev(last);
        if (entry->bytes > 0)
            erase(entry);
        else
            last = entry;
    }
    _entries.push_front({key, block, bytes});
    _byKey[key] = _entries.begin();
    _bytes += bytes;
}

void BlockCache::remove(const Key& key)
{
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto found = _byKey.find(key); found != _byKey.end()) erase(found->second);
}

void BlockCache::clear()
{
    std::lock_guard<std::mutex> lock(_mutex);
    _entries.clear();
    _byKey.clear();
    _bytes = 0;
}

std::size_t BlockCache::bytes() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _bytes;
}

void BlockCache::erase(Entries::iterator entry)
{
    _bytes -= entry->bytes;
    _byKey.erase(entry->key);
    _entries.erase(entry);
}

} // namespace osgVolumizer
