#pragma once

#include "SampleCache.h"

#include <functional>
#include <unordered_map>
#include <vector>

namespace osgVolumizer {
namespace picking {

/// Reads the samples of one level and time step for one pick. Its frame, the grid frame, has sample
/// (i,j,k) of the level at integer coordinates. A cell (i,j,k) lies between that sample and the
/// next ones; beyond the samples the outermost ones continue. For one thread.
class GridReader
{
public:
    /// \param wide filters touch a sample more on each side of a cell
    GridReader(const Voxels& voxels, int level, int step, bool wide);
    GridReader(const GridReader&) = delete;
    GridReader& operator=(const GridReader&) = delete;

    glm::ivec3 size() const { return _size; }
    /// voxel = spacing * grid + offset.
    double spacing() const { return _spacing; }
    double offset() const { return _offset; }
    /// A brick or page could not be read; it shows nothing.
    bool failed() const { return _failed; }

    using Shows = std::function<bool(const core::ValueRange&)>;
    /// A part of the grid within which values lie in a range.
    struct Part
    {
        core::Box3d box;        ///< grid frame
        bool shown = false;     ///< as far as is known without a look at its samples
        core::ValueRange range; ///< where that is known
    };
    /// The part that a cell lies in: the whole brick where its range shows nothing and is known
    /// without reading; else some cells of it.
    Part partAt(const glm::ivec3& cell, const Shows& shows);

    /// The samples at the corners of a cell, x fastest: `count` on each axis from `first` on.
    /// False where there are none.
    bool fetch(const glm::ivec3& cell, int first, int count, int component, double* values);
    /// Of the source; NaN where there is none.
    double rawSample(const glm::ivec3& place, int component);

    /// The bricks or pages that a box of the grid frame touches.
    struct Place
    {
        std::int64_t index = -1;
        core::Box3d box; ///< of its cells, grid frame; without end where the grid ends
    };
    std::vector<Place> placesIn(const core::Box3d& box) const;
    Place placeOf(const glm::ivec3& cell) const;
    /// Bytes of samples of a brick or page.
    std::int64_t bytesOf(std::int64_t index) const;
    /// Range of its values, where that is known without reading it now. Bricks that are not paged
    /// are read once for it.
    bool knownRange(std::int64_t index, core::ValueRange& range) const;

private:
    struct Loaded
    {
        Place place;
        bool rangeKnown = false;
        core::ValueRange range;
        ChunkPtr chunk; ///< null until it is needed
    };

    glm::ivec3 coordinatesOf(const glm::ivec3& cell) const;
    Place placeAt(const glm::ivec3& coordinates) const;
    Loaded& find(const glm::ivec3& cell);
    const SampleChunk& chunkOf(Loaded& loaded);

    const Voxels& _voxels;
    osg::ref_ptr<SampleCache> _cache;
    int _level, _step;
    bool _wide;
    bool _failed = false;
    double _spacing = 1.0, _offset = 0.0;
    glm::ivec3 _size{1}, _count{1};
    std::unordered_map<std::int64_t, Loaded> _loaded; ///< by index; few
    Loaded* _last = nullptr;                          ///< cells mostly have one neighbour's
};

} // namespace picking
} // namespace osgVolumizer
