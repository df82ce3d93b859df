#pragma once

#include "ReadVoxels.h"

#include <string>

namespace osgVolumizer {

/// Writes voxels as a 3D TIFF: one page a slice, lossless compression, BigTIFF beyond 4 GB. Other
/// formats that OpenImageIO can put several images in work too; the extension decides. Slice by
/// slice from the source, so that memory for one slice is enough. Nothing is left behind under
/// `fileName` unless all of it was written. The file keeps values (TIFF stores half as float32), and
/// a TIFF spacing, origin and axes, to the bit, as text that readVoxels() finds; ImageJ finds the
/// spacing. Of time steps the first.
///
/// Refused: NOT_SUPPORTED (extension, or voxel type in this format), FILE_UNREADABLE (cannot be
/// written).
OSGVOLUMIZER_EXPORT Status writeVoxels(const VoxelSource& source, const std::string& fileName,
                                       const Progress& progress = {});

} // namespace osgVolumizer
