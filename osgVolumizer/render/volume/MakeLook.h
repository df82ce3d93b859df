#pragma once

#include "VolumeInstance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// When the table can be applied, of what the appearance asks for. Expects voxels.
VolumeAppearance::Lookup usedLookup(const VolumeAppearance& appearance,
                                    const PreparedGeometry& prepared);

/// Whether periods can be chosen for an error tolerance: composited slabs without light, of voxels
/// of one component that are looked up after interpolation. Expects voxels.
bool canKeepTolerance(const VolumeAppearance& appearance, const PreparedGeometry& prepared);

/// What a volume's fragments are shaded with: appearance, prepared geometry, sampling and
/// frameToEye of the volume decide. What cannot be done as asked is reported once, and done as the
/// message says.
std::shared_ptr<const VolumeLook> makeLook(const VolumeInstance& volume, const TableTexture& table,
                                           osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
