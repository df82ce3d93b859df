#include "BinScan.h"

#include "../context/LeafState.h"
#include "ForeignLeaf.h"

#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <algorithm>

namespace osgVolumizer {
namespace render {

bool sortsByDepth(const osgUtil::RenderBin* bin)
{
    return bin && bin->getSortMode() == osgUtil::RenderBin::SORT_BACK_TO_FRONT &&
           !const_cast<osgUtil::RenderBin*>(bin)->getDrawCallback() &&
           !dynamic_cast<const osgUtil::RenderStage*>(bin);
}

namespace {

void collectBins(osgUtil::RenderBin& bin, std::vector<osgUtil::RenderBin*>& bins)
{
    bins.push_back(&bin);
    for (const auto& nested : bin.getRenderBinList())
        if (sortsByDepth(nested.second)) collectBins(*nested.second, bins);
}

bool anyWritesDepth(const osgUtil::RenderBin& bin)
{
    auto& b = const_cast<osgUtil::RenderBin&>(bin);
    const auto& leaves = b.getRenderLeafList();
    const auto& graphs = b.getStateGraphList();
    const auto writes = [](const auto& leaf) { return mayWriteDepth(*leaf); };
    return b.getDrawCallback() || std::any_of(leaves.begin(), leaves.end(), writes) ||
           std::any_of(graphs.begin(), graphs.end(), [&writes](const osgUtil::StateGraph* graph) {
               return std::any_of(graph->_leaves.begin(), graph->_leaves.end(), writes);
           });
}

// What is drawn from a bin before `end` is: whether it finds the bin, and whether depth was
// written.
struct DrawnBefore
{
    bool found = false, depthWritten = false;
};

void visitInDrawOrder(const osgUtil::RenderBin& bin, const osgUtil::RenderBin& end,
                      DrawnBefore& drawn)
{
    const auto& nested = const_cast<osgUtil::RenderBin&>(bin).getRenderBinList();
    for (auto i = nested.begin(); i != nested.end() && i->first < 0 && !drawn.found; ++i)
        visitInDrawOrder(*i->second, end, drawn);
    drawn.found = drawn.found || &bin == &end;
    if (drawn.found) return;
    drawn.depthWritten = drawn.depthWritten || anyWritesDepth(bin);
    for (auto i = nested.lower_bound(0); i != nested.end() && !drawn.found; ++i)
        visitInDrawOrder(*i->second, end, drawn);
}

} // namespace

std::vector<osgUtil::RenderBin*> binsOf(osgUtil::RenderBin& bin)
{
    std::vector<osgUtil::RenderBin*> bins;
    collectBins(bin, bins);
    return bins;
}

bool mayWriteDepth(const osgUtil::RenderLeaf& leaf)
{
    return writesDepth(leaf._parent) || !keepsState(*leaf.getDrawable());
}

bool isDepthClearedBefore(const osgUtil::RenderBin& bin)
{
    const auto* stage = const_cast<osgUtil::RenderBin&>(bin).getStage();
    if (!stage || !(stage->getClearMask() & GL_DEPTH_BUFFER_BIT) || stage->getClearDepth() != 1.0)
        return false;
    DrawnBefore drawn;
    visitInDrawOrder(*stage, bin, drawn);
    return drawn.found && !drawn.depthWritten;
}

} // namespace render
} // namespace osgVolumizer
