#pragma once

#include <osgVolumizer/VoxelSource.h>

#include <string>

namespace osgVolumizer {
namespace medical {

/// The header of a .nii file that the samples of a volume follow: NIfTI-1, or NIfTI-2 where an axis
/// is longer than that has room for. Where it lies is in the sform. RGBA of bytes is a type of its
/// own, RGBA of others a vector, whose components are planes one behind the other.
std::string niftiHeaderOf(const VoxelSource::Description& description);

} // namespace medical
} // namespace osgVolumizer
