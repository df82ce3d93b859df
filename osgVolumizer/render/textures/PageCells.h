#pragma once

#include "../../core/RecencyCache.h"
#include "../../core/voxels/BrickTree.h"
#include "BrickCells.h"

#include <memory>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// Where a page shows something, for linear interpolation: ranges are found once, which cells are
/// occupied once for each table. Thread safe.
class PageCells
{
public:
    PageCells(const Voxels& voxels, const core::TreeBrick& brick, const VoxelBlock& block);
    /// In the voxel frame of level 0.
    std::shared_ptr<const BrickCells> get(const Voxels& voxels, const OccupancyQuery& query);

    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state);

private:
    const core::TreeBrick _brick;
    core::CellGrid _grid; ///< in the frame of the level's samples
    core::LayerRanges _layers;
    std::mutex _mutex; ///< of what follows
    core::RecencyCache<OccupancyKey, std::shared_ptr<const BrickCells>> _cells{3};
};

} // namespace render
} // namespace osgVolumizer
