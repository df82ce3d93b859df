#pragma once

#include <osgUtil/RenderBin>

#include <vector>

namespace osgVolumizer {
namespace render {

/// Questions about a bin and those around it, once culling is over.

/// Whether a bin's leaves are drawn far to near, by nobody else's code.
bool sortsByDepth(const osgUtil::RenderBin* bin);

/// A bin and those nested in it that are one with it: all sorted by depth.
std::vector<osgUtil::RenderBin*> binsOf(osgUtil::RenderBin& bin);

/// Whether what a leaf draws may change the depth buffer.
bool mayWriteDepth(const osgUtil::RenderLeaf& leaf);

/// Whether the depth buffer is known to hold nothing but 1 when the bin's own leaves come.
bool isDepthClearedBefore(const osgUtil::RenderBin& bin);

} // namespace render
} // namespace osgVolumizer
