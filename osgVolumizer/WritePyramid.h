#pragma once

#include "ReadVoxels.h"
#include "core/voxels/Downsample.h"

#include <string>

namespace osgVolumizer {

struct PyramidOptions
{
    core::LevelRule rule = core::LevelRule::MEAN;
    /// What the voxels were made from, as one line: a file that was begun is gone on with only if
    /// this is the same, and their description.
    std::string origin;
};

/// Writes voxels and coarser copies of them as a tiled, losslessly compressed BigTIFF, which
/// readVoxels() pages from: io/PyramidFormat.h says what is where in it. Keeps spacing, origin and
/// axes; half and float64 become float32. Of time steps the first is written. Takes some 200 MB of
/// memory, whatever the size of the volume. Is written as `fileName` with ".part" in front of its
/// extension, and takes its name when it is whole: what was interrupted is gone on with when it is
/// written again.
///
/// Refused: VALUE_INVALID, FILE_UNREADABLE (cannot be written), and what the source refuses.
OSGVOLUMIZER_EXPORT Status writePyramid(const VoxelSource& source, const std::string& fileName,
                                        const PyramidOptions& options = {},
                                        const Progress& progress = {});
/// The same of the voxels of an appearance, with the spacing and origin that they have now. Refuses
/// (VALUE_INVALID) those without a source.
OSGVOLUMIZER_EXPORT Status writePyramid(const Voxels& voxels, const std::string& fileName,
                                        const PyramidOptions& options = {},
                                        const Progress& progress = {});

} // namespace osgVolumizer
