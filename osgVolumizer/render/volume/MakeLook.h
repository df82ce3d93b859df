#pragma once

#include "VolumeInstance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// What a volume's fragments are shaded with: appearance, prepared geometry, sampling and
/// frameToEye of the volume decide. What cannot be done as asked is reported once, and done as the
/// message says.
std::shared_ptr<const VolumeLook> makeLook(const VolumeInstance& volume, const TableTexture& table,
                                           osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
