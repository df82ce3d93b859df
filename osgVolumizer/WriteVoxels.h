#pragma once

#include "ReadVoxels.h"

#include <string>

namespace osgVolumizer {

/// Writes voxels as a 3D TIFF: one page a slice, lossless compression, BigTIFF beyond 4 GB. Other
/// formats that OpenImageIO can put several images in work too; the extension decides. Where the
/// plugin for it was built, NRRD (.nrrd, .nhdr), NIfTI (.nii, .nii.gz) and MetaImage (.mha, .mhd).
/// Slice by slice from the source, so that memory for one slice is enough. Nothing is left behind
/// under `fileName` unless all of it was written. The file keeps values (TIFF and those of plugins
/// store half as float32). A TIFF keeps spacing, origin and axes, to the bit, as text that
/// readVoxels() finds; ImageJ finds the spacing. Those of plugins keep them in LPS and millimetres,
/// however skewed: NIfTI-1 as float32. Of time steps the first.
///
/// Refused: NOT_SUPPORTED (extension, voxel type in this format, or a plugin that is not there),
/// FILE_UNREADABLE (cannot be written).
OSGVOLUMIZER_EXPORT Status writeVoxels(const VoxelSource& source, const std::string& fileName,
                                       const Progress& progress = {});
/// The same of the voxels of an appearance, with the spacing and origin that they have now. Refuses
/// (VALUE_INVALID) those without a source.
OSGVOLUMIZER_EXPORT Status writeVoxels(const Voxels& voxels, const std::string& fileName,
                                       const Progress& progress = {});

} // namespace osgVolumizer
