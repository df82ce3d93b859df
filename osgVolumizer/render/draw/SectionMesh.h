#pragma once

#include "../../private/SliceFaces.h"
#include "VolumeMesh.h"

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Triangles of a slice that are drawn from the same bricks.
struct SectionBatch
{
    std::vector<std::size_t> bricks; ///< one, or for slabs those that they reach into
    unsigned firstIndex = 0, indexCount = 0;
};

/// The faces of a slice, cut at the boxes of bricks. Immutable once made.
struct SectionMesh
{
    VolumeMesh arrays; ///< without batches; its colours are SliceFaces::ACROSS,
                       ///< and its spacings SliceFaces::DISTANCE
    /// Voxel coordinates are counted from here, since GL interpolates small numbers best.
    glm::dvec3 voxelBase{0.0};
    std::vector<SectionBatch> batches;
    std::size_t mostBricks = 1; ///< of a batch
    bool leavesOut = false;     ///< slabs reach into more bricks than there may be
};

/// \param boxes that are cut at, voxel frame; half-open, and apart from each other
/// \param thickness of a slab, object frame; 0 for none
/// \param mostBricks that may be drawn from at a time
std::shared_ptr<const SectionMesh> makeSectionMesh(const slices::SliceFaces& faces,
                                                   const std::vector<core::Box3d>& boxes,
                                                   double thickness, std::size_t mostBricks);

} // namespace render
} // namespace osgVolumizer
