#pragma once

#include "../../core/geometry/Box.h"

#include <optional>

namespace osgVolumizer {
namespace render {

/// What a surface through voxels needs of them in one view.
class TouchedBoxes
{
public:
    virtual ~TouchedBoxes() = default;

    /// Whether voxels of a box (voxel frame) are needed for what the view shows.
    virtual bool touches(const core::Box3d& box) const = 0;
    /// How many pixels a voxel of a box covers, at most, where it is not drawn where it is in the
    /// volume; else nothing.
    virtual std::optional<double> pixelsPerVoxel(const core::Box3d& box) const = 0;
};

} // namespace render
} // namespace osgVolumizer
