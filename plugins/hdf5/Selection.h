#pragma once

#include "Layout.h"

#include <osgVolumizer/core/geometry/Box.h>

#include <vector>

namespace osgVolumizer {
namespace hdf5 {

/// Samples of an axis of a file, and where they go.
struct Segment
{
    hsize_t start = 0, stride = 1, count = 1; ///< in the file
    hsize_t to = 0;                           ///< the first one, in the region that is read
};

/// For samples [min, max) of an axis, each of which stands for 2^halvings of `samples` of a file:
/// of those the one in the middle, as VoxelSource::readThinned(). Where the file ends before that,
/// its last, which has a segment of its own.
std::vector<Segment> segmentsOf(int min, int max, int halvings, int samples);

/// One segment for each axis, x, y, z.
struct Selection
{
    Segment axes[3];

    /// Of a dataset of `rank` axes.
    Handle inFile(hid_t dataset, int rank, const Axes& where, int step) const;
    /// Of a region of `size`, tightly packed.
    Handle inMemory(const glm::ivec3& size) const;
};

/// What together makes a region of a level: one selection, or more at the ends of the volume.
std::vector<Selection> selectionsOf(const core::Box3i& region, int level, const FileLevel& from);

} // namespace hdf5
} // namespace osgVolumizer
