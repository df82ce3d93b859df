#pragma once

#include "../../Voxels.h"
#include "PickData.h"
#include "SampleChunk.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

namespace osgVolumizer {
namespace picking {

using ChunkPtr = std::shared_ptr<const SampleChunk>;

/// What is kept with Voxels: the bricks or pages that picks have read last, so that a pick reads
/// none again. Thread safe.
class SampleCache : public PickData
{
public:
    /// Bound on samples that are not in the source's memory anyway; one chunk at least is kept.
    static constexpr std::size_t MAXIMUM_BYTES = std::size_t(256) << 20;

    /// The samples of a brick (step 0), or of a page at a time step: read where they are not there,
    /// or have changed, of a brick only those that have. Never null.
    ChunkPtr get(const Voxels& voxels, std::int64_t index, int step);
    /// Bricks and pages that were read since construction.
    std::uint64_t readCount() const;

private:
    struct Key
    {
        std::int64_t index;
        int step;
        bool operator<(const Key& o) const
        {
            return index != o.index ? index < o.index : step < o.step;
        }
    };
    struct Entry
    {
        std::shared_ptr<SampleChunk> chunk;
        unsigned layoutCount = 0, modifiedCount = 0;
        std::uint64_t used = 0;
    };

    bool update(const Voxels& voxels, std::int64_t index, unsigned modified, Entry& entry);
    void keep(const Key& key, Entry entry);
    void forgetLeastRecent(const Key& but);

    mutable std::mutex _mutex; // of what follows
    std::map<Key, Entry> _entries;
    std::size_t _bytes = 0;
    std::uint64_t _clock = 0, _readCount = 0;
};

} // namespace picking
} // namespace osgVolumizer
