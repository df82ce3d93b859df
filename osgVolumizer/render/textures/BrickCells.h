#pragma once

#include "TableTextures.h"

#include "../../Voxels.h"
#include "../../core/cutting/Cut.h"
#include "../../core/geometry/Box.h"
#include "../../core/voxels/LayerRanges.h"
#include "../../core/voxels/Occupancy.h"

#include <osg/Texture3D>

#include <glm/vec3.hpp>

#include <cstdint>
#include <map>
#include <memory>

namespace osgVolumizer {
namespace render {

/// Where a brick shows something under one table.
struct BrickCells
{
    core::Box3d box;          ///< voxel frame; around what shows, to one sample; empty for nothing
    bool homogeneous = false; ///< all samples have one value
    /// Chebyshev distance of each cell, in cells, to the next occupied one, as bytes.
    osg::ref_ptr<osg::Texture3D> texture;
    glm::vec3 origin{0.0f}; ///< voxel frame; corner of cell (0,0,0)
    float cellSize = 1.0f;
    /// In the box: all cells, and those that show something.
    std::int64_t cellCount = 0, occupiedCount = 0;
    /// What is marched through where empty cells are leapt over from both ends of a ray, cubic
    /// voxels: mean over rays along the axes. Nothing in homogeneous bricks.
    double marchedVolume = 0.0;
    /// Of cells that are joined: the same of each part by itself, summed.
    double apartMarchedVolume = 0.0;
};

/// What decides which values are shown.
struct OccupancyQuery
{
    const TableTexture* table = nullptr;
    bool cubic = false;      ///< values overshoot the samples'
    bool isosurface = false; ///< only this value is shown
    double isoFraction = 0.0;
    std::shared_ptr<const core::Cut> cut; ///< what it leaves; null: all
};

/// What answers to queries depend on.
struct OccupancyKey
{
    unsigned tableId = 0;
    bool cubic = false, isosurface = false;
    double isoFraction = 0.0;
    unsigned cutId = 0;
    bool operator==(const OccupancyKey& o) const
    {
        return tableId == o.tableId && cubic == o.cubic && isosurface == o.isosurface &&
               isoFraction == o.isoFraction && cutId == o.cutId;
    }
};
OccupancyKey occupancyKey(const Voxels& voxels, const OccupancyQuery& query);

/// The component that decides what shows: the value, or alpha.
int shownComponent(const Voxels& voxels);

/// BrickCells::texture of one cell that is occupied.
osg::Texture3D* occupiedEverywhere();

/// Whether anything is shown of data values between two, low <= high.
bool showsValues(const Voxels& voxels, const OccupancyQuery& query, double low, double high);

/// A box of the voxel frame, in the frame of cuts.
core::Box3d boxToCut(const Voxels& voxels, const core::Box3d& box);

/// A frame of samples: voxel coordinate = offset + spacing * coordinate.
struct SampleFrame
{
    double spacing = 1.0, offset = 0.0; ///< the same along all axes

    core::Box3d toVoxels(const core::Box3d& box) const
    {
        return {spacing * box.min + offset, spacing * box.max + offset};
    }
};

/// The cells of a brick whose ranges are known. \param layers of the same samples
/// \param frame of place and grid
std::shared_ptr<const BrickCells> findOccupied(const Voxels& voxels, const core::BrickPlace& place,
                                               const core::CellGrid& grid,
                                               const core::LayerRanges& layers,
                                               const OccupancyQuery& query,
                                               const SampleFrame& frame = {});
/// The cells of some bricks, by number, as of one; those of all other bricks show nothing.
std::shared_ptr<const BrickCells>
joinCells(const Voxels& voxels,
          const std::map<std::int64_t, std::shared_ptr<const BrickCells>>& parts);
/// Samples along the edge of a cell of a brick, or a volume, of a size.
int cellSizeFor(const glm::ivec3& samples);

} // namespace render
} // namespace osgVolumizer
