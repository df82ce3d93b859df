#pragma once

#include "../../core/ordering/DepthSchedule.h"

#include <osgUtil/RenderLeaf>

#include <algorithm>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Leaves in the order in which they are to be drawn, each with the depth that it is sorted by.
class LeafList
{
public:
    struct Entry
    {
        double depth; ///< eye units
        osgUtil::RenderLeaf* leaf;
    };

    void add(double depth, osgUtil::RenderLeaf* leaf) { _entries.push_back({depth, leaf}); }
    void append(const LeafList& other)
    {
        _entries.insert(_entries.end(), other.begin(), other.end());
    }
    bool empty() const { return _entries.empty(); }
    std::vector<Entry>::const_iterator begin() const { return _entries.begin(); }
    std::vector<Entry>::const_iterator end() const { return _entries.end(); }

    /// The nearest and the farthest depth; expects one leaf at least.
    core::DepthInterval ends() const
    {
        const auto found = std::minmax_element(
            begin(), end(), [](const Entry& a, const Entry& b) { return a.depth < b.depth; });
        return {found.first->depth, found.second->depth};
    }
    /// Puts one leaf before all others, at the farthest depth, and one after them, at the nearest.
    void enclose(osgUtil::RenderLeaf* first, osgUtil::RenderLeaf* last)
    {
        const core::DepthInterval depth = ends();
        _entries.insert(_entries.begin(), {depth.farDepth, first});
        _entries.push_back({depth.nearDepth, last});
    }
    /// Those of equal depth keep their order.
    void sortFarToNear()
    {
        std::stable_sort(_entries.begin(), _entries.end(),
                         [](const Entry& a, const Entry& b) { return a.depth > b.depth; });
    }

private:
    std::vector<Entry> _entries;
};

} // namespace render
} // namespace osgVolumizer
