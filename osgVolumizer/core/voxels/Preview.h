#pragma once

#include "VoxelData.h"

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A regular subset of a volume's samples (first component), of about four million at most: what
/// is found out from it takes some milliseconds however large the volume is.
class OSGVOLUMIZER_CORE_EXPORT Preview
{
public:
    /// \param spacing of the samples that are added, in samples of the volume
    explicit Preview(const glm::ivec3& size, int spacing = 1);
    /// Adds a part of the volume that starts at sample `origin`. Parts may overlap.
    void add(const VoxelView& part, const glm::ivec3& origin = glm::ivec3(0));

    /// The subset; NaN where no part was added.
    VoxelView view() const;
    /// Samples of the volume per sample of the subset, along each axis.
    int step() const { return _step * _spacing; }

    /// Mean square of the difference between samples two apart over that between neighbours, along
    /// x: 4 where values run smoothly, 2 across jumps, 1 in noise; 0 where nothing varies.
    double smoothness() const;

private:
    int _step = 1, _spacing = 1;
    glm::ivec3 _size;
    std::vector<float> _values;
    double _one = 0.0, _two = 0.0; ///< sums of squares
};

} // namespace core
} // namespace osgVolumizer
