#pragma once

#include <osgVolumizer/VoxelSource.h>

#include <string>

namespace osgVolumizer {
namespace medical {

/// Writes .nrrd, .nhdr, .nii, .nii.gz, .mha and .mhd (of vol.nhdr and vol.mhd the samples are in
/// vol.nhdr.raw and vol.mhd.raw, which must not be there without them), slice by slice: values,
/// type (half as float32), RGBA, and where the voxels lie in LPS, however skewed. NIfTI stores
/// places as float32. Nothing is left behind unless all of it was written; of time steps the first.
/// A text begins with the path: NOT_SUPPORTED (another name), FILE_UNREADABLE (cannot be written),
/// and what the source refuses.
Status writeFile(const VoxelSource& source, const std::string& path);

} // namespace medical
} // namespace osgVolumizer
