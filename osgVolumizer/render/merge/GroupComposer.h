#pragma once

#include "MergedGroup.h"

namespace osgVolumizer {
namespace render {

/// Adds the leaves of one group, far to near: a volume by itself is one leaf; where there are
/// surfaces, each region of the viewport is merged in the first way that it suits: captured,
/// ranked, by intervals.
void composeGroup(const MergeGroup& group, const MergeFrame& frame, LeafList& leaves);

} // namespace render
} // namespace osgVolumizer
