#pragma once

#include "MergedGroup.h"

namespace osgVolumizer {
namespace render {

/// What limits how many volumes one march may have.
struct FuseLimits
{
    int volumes = 8;       ///< in one march
    int textureUnits = 32; ///< of the context that will draw
};

/// Takes volumes that can be marched together out of a list and puts them back as one, or, where
/// they are too many for one march, as few as possible. A volume by itself is marched with its own
/// bricks where it has several and `splitBricks` holds. The others stay what they are.
void fuseVolumes(std::vector<MergedVolume>& volumes, const FuseLimits& limits, bool splitBricks);

} // namespace render
} // namespace osgVolumizer
