#pragma once

#include "../voxels/VoxelData.h"
#include "TransferFunction.h"

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Histograms of a volume's values over the fraction of a range: of everything, of the inner half
/// (an eighth of the volume) and of the outermost samples. From a regular subset of about four
/// million samples at most, so a pass takes some milliseconds however large the volume is.
class OSGVOLUMIZER_CORE_EXPORT ScanStatistics
{
public:
    static constexpr int BINS = 256;

    /// `range`: data values at the ends; low < high. Values beyond count at the ends, NaN does not
    /// count.
    ScanStatistics(const glm::ivec3& volumeSize, const ValueRange& range);
    /// Adds a part of the volume that starts at sample `origin`.
    void add(const VoxelView& part, const glm::ivec3& origin = glm::ivec3(0));

    const std::vector<std::uint64_t>& all() const { return _all; }
    const std::vector<std::uint64_t>& inner() const { return _inner; }
    const std::vector<std::uint64_t>& border() const { return _border; }
    const glm::ivec3& volumeSize() const { return _size; }

private:
    glm::ivec3 _size;
    ValueRange _range;
    int _step = 1;
    std::vector<std::uint64_t> _all, _inner, _border;
};

/// The bin above which values belong to the upper of two classes, such that the classes differ
/// most: Otsu, "A Threshold Selection Method from Gray-Level Histograms", IEEE Trans. SMC 9, 1979.
/// In the middle of the gap where there is one. 0 to BINS - 2; -1 where fewer than two bins are
/// filled.
OSGVOLUMIZER_CORE_EXPORT int otsuThreshold(const std::vector<std::uint64_t>& histogram);

/// A look that shows something sensible of any scan, over the fraction [0, 1] of the statistics'
/// range. Otsu's threshold parts the values into two classes; the one that prevails on the outside
/// of the volume is background and transparent. From the threshold to the value that all but 0.1 %
/// of the foreground lies within, opacity rises, fast at first, and so does brightness, from dark
/// red over skin to ivory. The highest opacity is such that a ray through the inner half of the
/// volume, seen along an axis, has an optical depth of 12 over the whole volume's width: solid,
/// with what is just below its surface still showing. The opacity unit is taken to be the voxels'
/// mean spacing. \param voxelsPerSample distance between samples, in voxels
OSGVOLUMIZER_CORE_EXPORT TransferFunction suggestTransferFunction(const ScanStatistics& statistics,
                                                                  int voxelsPerSample = 1);

} // namespace core
} // namespace osgVolumizer
