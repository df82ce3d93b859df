#pragma once

#include "../volume/VolumeInstance.h"

#include <vector>

namespace osgVolumizer {
namespace render {

/// Gives volumes the paint of those whose combine rule says so, and takes these out of the list:
/// they show nothing by themselves. The result does not depend on the order of volumes.
void applyPaint(std::vector<VolumeInstance*>& volumes);

} // namespace render
} // namespace osgVolumizer
