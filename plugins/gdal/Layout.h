#pragma once

#include "Axis.h"
#include "Calibration.h"
#include "Roles.h"

#include <osgVolumizer/VoxelSource.h>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace gdal {

/// How a variable is a volume.
struct Layout
{
    VoxelSource::Description description;
    Axis axes[3];  ///< x, y, z
    int time = -1; ///< dimension; -1: there is none
    int steps = 1;
    VoxelType numbers = VoxelType::UINT8; ///< of the file, as they are read
    Calibration calibration;
    std::vector<std::string> notices; ///< what a user may not expect, sentences without the file
};

/// Where the voxels of a variable lie: in the units of its coordinates, with z upwards where the
/// file says that they are positive downwards, or they are pressures or depths and it says nothing;
/// in metres where x and y are degrees and z is a length, or all are lengths of several units.
/// VALUE_INVALID, TOO_LARGE; texts lack the path. Expects a Session. \param dimensions as said, or
/// empty \param driver as calibrationOf()
Result<Layout> layoutOf(const Variable& variable, const std::string& dimensions,
                        const std::string& driver);

} // namespace gdal
} // namespace osgVolumizer
