#pragma once

#include "../draw/Accumulation.h"
#include "../volume/VolumeInstance.h"

#include <osgUtil/RenderBin>

#include <unordered_set>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What is drawn of a bin between the first and the last of our leaves.
struct AccumulatedLeaves
{
    const osgUtil::RenderBin& bin;
    const std::vector<osgUtil::RenderLeaf*>& leaves; ///< of the bin, before merging
    const std::unordered_set<const osgUtil::RenderLeaf*>&
        replaced;             ///< those of them that ours replace
    core::DepthInterval ends; ///< of ours
};

/// Tells accumulation what leaves between its ends need of the framebuffer: stencil values; and,
/// where they are not ours, what they leave in the depth buffer, and fixed-point values for logic.
void tellNeeds(const AccumulatedLeaves& drawn, Accumulation& accumulation);

/// Tells accumulation what need not be copied where volumes are drawn by themselves.
/// \param viewport of all volumes; null where they have several
void tellUnneeded(const AccumulatedLeaves& drawn, const std::vector<VolumeInstance*>& volumes,
                  const glm::ivec4* viewport, Accumulation& accumulation);

} // namespace render
} // namespace osgVolumizer
