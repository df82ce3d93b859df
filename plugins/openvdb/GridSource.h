#pragma once

#include <osgVolumizer/VoxelSource.h>
#include <osgVolumizer/core/Status.h>
#include <osgVolumizer/io/VoxelFiles.h>

#include <openvdb/openvdb.h>

#include <optional>
#include <string>

namespace osgVolumizer {
namespace vdb {

/// A grid with its tree, which nobody changes any more.
struct GridToShow
{
    openvdb::GridBase::ConstPtr grid;
    openvdb::CoordBBox box;               ///< of its active voxels: what the volume is
    VoxelSource::Description description; ///< all but the type
};

/// The box of a grid's active voxels and where they lie. NOT_SUPPORTED for a grid whose voxels lie
/// in no straight lines (of a camera), or whose values are no numbers; FILE_UNREADABLE where it has
/// no active voxels; TOO_LARGE for more than 2^31 - 1 along an axis. Texts lack the path.
Result<GridToShow> gridToShow(const openvdb::GridBase::ConstPtr& grid);

/// The voxels of a grid: null where its values are no vectors, or none that are known.
io::Source sourceOfNumbers(const GridToShow& grid);
/// Of one of three components, or of their length.
io::Source sourceOfVectors(const GridToShow& grid, std::optional<int> component);

/// What a type of grid is read as, by its name (openvdb::GridBase::type()).
struct GridKind
{
    VoxelType type = VoxelType::FLOAT32;
    int channels = 1; ///< 3 for vectors
};
/// None for points, texts and the like. \param half the grid says that its file has halves
std::optional<GridKind> kindOf(const std::string& type, bool half);

} // namespace vdb
} // namespace osgVolumizer
