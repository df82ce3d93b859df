#pragma once

#include "MergedGroup.h"

namespace osgVolumizer {
namespace render {

/// Makes leaves of intervals in which nothing but volumes is, far to near: as few as the order of
/// volumes allows, since what is drawn of one volume without another between is one leaf.
///
/// Several volumes are drawn in slabs one step thick, in alternating order: the error of
/// drawing one slab of A behind one of B, ½ tauA tauB h² (cA - cB), has the other sign in the next
/// slab, so it cancels, and what remains is second order in h and independent of which one is A.
class SlabQueue
{
public:
    /// What is drawn of each of the group's volumes.
    using Parts = std::vector<std::shared_ptr<const VolumePart>>;

    SlabQueue(const MergedGroup& group, const Parts& parts, LeafList& leaves)
        : _group(group), _parts(parts), _leaves(leaves)
    {
    }
    SlabQueue(const SlabQueue&) = delete;
    SlabQueue& operator=(const SlabQueue&) = delete;
    ~SlabQueue() { flush(); }

    /// \param order of volumes, by number
    void add(const core::DepthInterval& interval, const std::vector<int>& order);
    /// Adds the leaf of what has been collected.
    void flush();

private:
    const MergedGroup& _group;
    const Parts& _parts;
    LeafList& _leaves;
    std::vector<core::DepthInterval> _intervals; ///< of _volume
    std::size_t _volume = 0;
};

/// The order of volumes in one of several intervals: it is reversed in every second one.
std::vector<int> alternatingOrder(const core::ScheduledInterval& interval, std::size_t number);
/// The middle of an interval, which its leaves are sorted by.
inline double middleOf(const core::DepthInterval& d)
{
    return 0.5 * (d.nearDepth + d.farDepth);
}
/// The intervals of a region's surfaces, given by number, and the group's volumes. Members are the
/// volumes, then the surfaces.
std::vector<core::ScheduledInterval> scheduleOf(const MergedGroup& group,
                                                const std::vector<std::size_t>& surfaces);

} // namespace render
} // namespace osgVolumizer
