#pragma once

#include "../SlabQueue.h"

#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace render {

/// Merges surfaces with volumes by cutting depth into intervals: the way that always works, and the
/// cheapest where there are many triangles.
///
/// An interval of volumes and surfaces is drawn as: the surfaces' nearest depth into a buffer, the
/// volumes behind that depth, the surfaces, the volumes in front of it. This is exact where a pixel
/// has one surface in the interval, and off by the interval's thickness where it has more.
class IntervalSurfaces
{
public:
    IntervalSurfaces(const MergedGroup& group, const MergeRegion& region);
    void compose(LeafList& leaves) const;

private:
    /// A surface, cut at the intervals.
    struct Pieces
    {
        const MergedSurface* surface = nullptr;
        core::DepthInterval ends;                  ///< of the intervals that it is drawn in
        std::vector<SurfaceMesh::Indices> indices; ///< per interval; empty without a mesh
    };
    Pieces piecesOf(std::size_t number) const;
    void composeMixed(std::size_t interval, LeafList& leaves) const;
    void addSplit(std::size_t interval, LeafList& leaves) const;
    void addPieces(std::size_t interval, bool depthOnly, LeafList& leaves) const;

    const MergedGroup& _group;
    const MergeRegion& _region;
    SlabQueue::Parts _whole, _behind, _inFront; ///< per volume; of surfaces in an interval
    std::vector<core::ScheduledInterval> _intervals;
    std::vector<Pieces> _pieces; ///< per surface of the region
};

} // namespace render
} // namespace osgVolumizer
