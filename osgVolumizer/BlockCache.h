#pragma once

#include "VoxelSource.h"

#include <cstdint>
#include <list>
#include <mutex>
#include <unordered_map>
#include <utility>

namespace osgVolumizer {

/// The blocks of samples that were used last, within a bound of bytes. Blocks that share their
/// source's memory cost nothing and all stay. Thread safe.
class BlockCache
{
public:
    /// A brick in one state of its data.
    using Key = std::pair<std::int64_t, unsigned>;

    /// \param maximumBytes of blocks with memory of their own
    explicit BlockCache(std::size_t maximumBytes) : _maximumBytes(maximumBytes) {}

    /// Empty where it is not there.
    VoxelBlock find(const Key& key);
    /// Replaces what the key had. A block that is larger than the bound by itself is not kept.
    void add(const Key& key, const VoxelBlock& block, bool shared);
    void remove(const Key& key);
    void clear();
    /// Counts blocks with memory of their own.
    std::size_t bytes() const;

private:
    struct Hash
    {
        std::size_t operator()(const Key& key) const
        {
            return std::hash<std::int64_t>()(key.first * 31 + std::int64_t(key.second));
        }
    };
    struct Entry
    {
        Key key;
        VoxelBlock block;
        std::size_t bytes;
    };
    using Entries = std::list<Entry>;

    void erase(Entries::iterator entry);

    const std::size_t _maximumBytes;
    mutable std::mutex _mutex; // of what follows
    Entries _entries;          // most recent first
    std::unordered_map<Key, Entries::iterator, Hash> _byKey;
    std::size_t _bytes = 0;
};

} // namespace osgVolumizer
