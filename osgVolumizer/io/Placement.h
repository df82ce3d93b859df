#pragma once

#include "../VoxelSource.h"

namespace osgVolumizer {
namespace io {

/// Sets spacing, axes and origin of `description` so that voxel v lies at `position` + `steps` * v
/// in the frame of the file, where `steps` has a column for each voxel axis: skewed and left-handed
/// ones as they are. Frame: millimetres, x to the left of the patient, y to the back, z to the head
/// (LPS) for medical files; for all others whatever their own is.
/// VALUE_INVALID, and nothing changed, where the steps are not finite, or span no volume.
OSGVOLUMIZER_EXPORT Status place(VoxelSource::Description& description, const glm::dmat3& steps,
                                 const glm::dvec3& position);

/// Where voxel v of a volume lies in that frame: axes * (origin + spacing * v).
OSGVOLUMIZER_EXPORT glm::dvec3 placeOf(const VoxelSource::Description& description,
                                       const glm::dvec3& voxel);

} // namespace io
} // namespace osgVolumizer
