#pragma once

#include "Values.h"

#include <osgVolumizer/core/voxels/VoxelType.h>

#include <limits>
#include <optional>
#include <vector>

namespace osgVolumizer {
namespace gdal {

/// What the numbers of an array mean.
struct Calibration
{
    double scale = 1.0, offset = 0.0;
    std::vector<double> missing; ///< as in the file
    /// What NetCDF fills integers with that nobody wrote, where the file says nothing of holes: it
    /// is missing where it is there.
    std::optional<double> filling;
    double low = -std::numeric_limits<double>::infinity(); ///< valid ones, as in the file
    double high = std::numeric_limits<double>::infinity();
    bool asFloat = false; ///< numbers of the file are 32-bit floats

    bool isPlain() const { return scale == 1.0 && offset == 0.0 && !hasHoles(); }
    bool hasHoles() const;
    /// Turns numbers of the file into values; holes become NaN.
    void apply(double* values, std::size_t count) const;
};

/// scale_factor and add_offset; _FillValue, missing_value, valid_min, valid_max, valid_range; the
/// fill value of Zarr unless that is 0, which many write without a meaning; and what NetCDF itself
/// fills floats, and integers but bytes, with. Expects a Session. \param driver "netCDF", "Zarr",
/// "HDF5"
Calibration calibrationOf(const GDALMDArray& array, const std::string& driver);

/// The voxel type that holds all numbers of the file's type; FLOAT64 where there is none.
VoxelType typeOf(const GDALMDArray& array);
/// GDAL's name for it.
GDALDataType gdalType(VoxelType type);
/// The type of values: that of the numbers where they stay as they are, else a float.
VoxelType valueType(VoxelType numbers, const Calibration& calibration, bool interpolated);

} // namespace gdal
} // namespace osgVolumizer
