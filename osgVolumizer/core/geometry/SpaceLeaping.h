#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Box.h"
#include "TetraSet.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Lowest and highest value in a cell.
struct CellRange
{
    float minimum = 0.0f, maximum = 0.0f;
};

/// Space leaping: boxes that cover the occupied cells of a grid, none twice, no empty cell. Runs of
/// cells are merged along x, then equal runs along y, then equal sheets along z, greedily, inside
/// regions of REGION^3 cells; so few boxes are made, and when the table changes only the regions
/// whose occupancy differs are done again. Keeps its memory.
class OSGVOLUMIZER_CORE_EXPORT SpaceLeaper
{
public:
    static constexpr int REGION = 16; ///< cells per axis

    /// \param cells number of cells per axis, each >= 1
    /// \param ranges one per cell, x fastest
    /// SIZE_MISMATCH, VALUE_INVALID (NaN or minimum > maximum, with the index), TOO_LARGE for more
    /// than 2^31 cells. Nothing is occupied until update().
    Status setRanges(const glm::ivec3& cells, std::vector<CellRange> ranges);

    /// Decides anew which cells are occupied; true where any changed. `opaque` tells whether the
    /// table shows anything of values in a range.
    bool update(const std::function<bool(float minimum, float maximum)>& opaque);

    /// The boxes, in cells, half-open; region by region.
    const std::vector<Box3i>& boxes() const { return _boxes; }
    std::int64_t occupiedCells() const { return _occupiedCells; }
    /// Regions that the last update() merged anew.
    int regionsMerged() const { return _regionsMerged; }
    bool occupied(const glm::ivec3& cell) const { return _occupied[index(cell)] != 0; }

    /// The boxes in the voxel frame: cell (i,j,k) spans cellSize from (i,j,k) * cellSize, cut at
    /// `extent`.
    std::vector<Box3d> voxelBoxes(const glm::ivec3& cellSize, const Box3d& extent) const;
    /// The same as tetrahedra, five per box, V3F. Boxes of different size meet with hanging
    /// vertices, where pixels may be covered twice or not at all; used as clip boxes they tile
    /// exactly.
    TetraSet tetraSet(const glm::ivec3& cellSize, const Box3d& extent) const;

private:
    std::size_t index(const glm::ivec3& c) const
    {
        return static_cast<std::size_t>(c.x) +
               static_cast<std::size_t>(_cells.x) *
                   (static_cast<std::size_t>(c.y) +
                    static_cast<std::size_t>(_cells.y) * static_cast<std::size_t>(c.z));
    }
    Box3i regionCells(std::size_t region) const;
    void mergeRegion(std::size_t region);

    glm::ivec3 _cells{0};
    glm::ivec3 _regions{0};
    std::vector<CellRange> _ranges;
    std::vector<std::uint8_t> _occupied;
    std::vector<std::vector<Box3i>> _regionBoxes;
    std::vector<Box3i> _boxes;
    std::vector<std::uint8_t> _left; ///< of a region: occupied cells not yet in a box
    std::int64_t _occupiedCells = 0;
    int _regionsMerged = 0;
};

} // namespace core
} // namespace osgVolumizer
