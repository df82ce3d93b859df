#pragma once

#include "../../VoxelSource.h"
#include "../../core/voxels/Occupancy.h"
#include "../../core/voxels/VoxelData.h"

#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

namespace osgVolumizer {
namespace picking {

/// The samples of one brick or page in memory, with the ranges of its cells of 8^3 (8 bytes each:
/// 1.6 % of 8-bit samples). Holes, NaN and infinite values, are filled with the lowest value of the
/// voxels' range, which is what is drawn of them. Immutable but for update(); thread safe.
class SampleChunk
{
public:
    static constexpr int CELL = 8; ///< samples along the edge of a cell that has a range

    /// \param samples where the block's samples lie in their level, half-open
    /// \param component whose ranges are asked for
    /// \param ownBytes that the block takes, 0 where its source has it in memory anyway
    SampleChunk(VoxelBlock block, const core::VoxelView& view, const core::Box3i& samples,
                int component, double lowest, std::size_t ownBytes);

    /// Takes samples that have changed, those of boxes inside, without a look at the others; false
    /// where that cannot be done, and all have to be read. Expects nobody else to use the chunk.
    /// \param shared whether the block is the source's own memory, and so has the new samples
    /// \param read the samples of a box; empty where the source fails
    using Read = std::function<VoxelBlock(const core::Box3i&)>;
    bool update(const std::vector<core::Box3i>& changed, bool shared, const Read& read);
    const VoxelBlock& block() const { return _block; }

    /// False where the source failed.
    bool wasRead() const { return _raw.data != nullptr; }
    /// False there, and where there are holes only: nothing is shown.
    bool hasSamples() const { return _view.data != nullptr; }
    const core::Box3i& samples() const { return _samples; }
    /// Of samples and of what holes are filled in.
    std::size_t ownBytes() const { return _ownBytes; }

    /// Values at indices into the block (of voxels), as they are drawn.
    void fetch(const std::int64_t* indices, int count, int component, double* values) const;
    /// The sample at a place of its level, which is held within the chunk; as it is in the source.
    double rawSample(const glm::ivec3& place, int component) const;
    glm::ivec3 size() const { return _view.size; }

    /// Ranges of the cells, for filters that touch a sample more on each side, or not.
    const core::CellGrid& cells(bool wide) const;

private:
    using Fetch = void (*)(const void* data, const std::int64_t* indices, int count, int stride,
                           int component, double* values);

    void fillHoles(double lowest);
    void makeOwn();
    bool replace(const core::Box3i& box, const VoxelBlock& samples);
    void updateCells(const std::vector<core::Box3i>& changed);

    VoxelBlock _block, _filled;
    core::VoxelView _raw, _view;
    core::Box3i _samples;
    int _component;
    std::size_t _ownBytes;
    Fetch _fetch = nullptr;
    mutable std::mutex _mutex;        // of the next
    mutable core::CellGrid _cells[2]; // linear, cubic; empty until asked for
};

} // namespace picking
} // namespace osgVolumizer
