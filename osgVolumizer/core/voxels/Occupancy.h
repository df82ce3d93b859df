#pragma once

#include "../Export.h"
#include "VoxelData.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A brick's drawn box cut into cubic cells, with the range of the samples that a filter can touch
/// when it is evaluated anywhere in the closed cell. Cell (i,j,k) is the voxels' coordinates origin
/// + cellSize * [i, i+1] and so on, cut off at the brick's last sample. x fastest.
struct CellGrid
{
    glm::dvec3 originVoxel{0.0}; ///< voxel frame of the samples scanned: where cell (0,0,0) starts
    int cellSize = 8;            ///< edge, in voxels
    glm::ivec3 count{0};
    /// Lowest and highest finite value per cell, rounded outwards to float; low > high where a cell
    /// has no finite value, and so shows nothing.
    std::vector<float> low, high;

    std::size_t cellCount() const { return low.size(); }
    std::size_t index(int x, int y, int z) const
    {
        return static_cast<std::size_t>(x) +
               static_cast<std::size_t>(count.x) *
                   (static_cast<std::size_t>(y) +
                    static_cast<std::size_t>(count.y) * static_cast<std::size_t>(z));
    }
};

/// Samples beyond a cell's own that a filter touches on each side.
enum class FilterSupport : int
{
    LINEAR = 0,
    CUBIC = 1
};

/// Cells of a brick whose samples are `view`; cell (0,0,0) starts at its sample (0,0,0), taken to
/// lie at `originVoxel`. cellSize >= 1. One pass over the data. For an interpolating cubic filter,
/// which overshoots its samples, the caller has to widen the ranges; a cubic B-spline stays within
/// them.
OSGVOLUMIZER_CORE_EXPORT CellGrid scanCells(const VoxelView& view, int cellSize,
                                            const glm::dvec3& originVoxel = glm::dvec3(0.0),
                                            FilterSupport support = FilterSupport::LINEAR,
                                            int component = 0);

/// Cells whose filters touch any sample of some boxes, voxel frame: indices, each once.
OSGVOLUMIZER_CORE_EXPORT std::vector<std::size_t>
cellsTouching(const CellGrid& grid, FilterSupport support, const std::vector<Box3i>& samples);
/// The samples that filters in a cell touch, within a brick's; voxel frame.
OSGVOLUMIZER_CORE_EXPORT Box3i cellSamples(const CellGrid& grid, std::size_t cell,
                                           FilterSupport support, const Box3i& brickSamples);
/// Sets the range of a cell, rounded outwards.
OSGVOLUMIZER_CORE_EXPORT void setCellRange(CellGrid& grid, std::size_t cell,
                                           const ValueRange& range);

/// 255 for each cell where maximumOpacity(low, high), data values, exceeds `threshold`; else 0.
OSGVOLUMIZER_CORE_EXPORT std::vector<std::uint8_t>
occupiedCells(const CellGrid& grid,
              const std::function<double(double low, double high)>& maximumOpacity,
              double threshold = 0.0);

/// Chebyshev distance, in cells, from each cell to the nearest occupied one (non-zero in
/// `occupied`): 0 where occupied, 255 for that and more, and where nothing is occupied. A ray in a
/// cell of distance d > 0 meets nothing within the cube of cells up to d - 1 away. Two-pass
/// chamfer, exact for this metric (Rosenfeld and Pfaltz, "Distance functions on digital pictures",
/// Pattern Recognition 1, 1968); its use: Deakin and Knackstedt, "Accelerated Volume Rendering with
/// Chebyshev Distance Maps", SIGGRAPH Asia 2019.
OSGVOLUMIZER_CORE_EXPORT std::vector<std::uint8_t>
chebyshevDistance(const glm::ivec3& count, const std::vector<std::uint8_t>& occupied);

} // namespace core
} // namespace osgVolumizer
