#pragma once

#include "../MergedGroup.h"
#include "CaptureLeaf.h"
#include "CaptureSlots.h"

#include <optional>

namespace osgVolumizer {
namespace render {

/// Merges surfaces of one usual blending with one volume that is drawn as one: their fragments are
/// captured, and composited while the volume is marched. See CaptureLeaf; exact, and the fastest
/// way.
class CapturedSurfaces
{
public:
    /// Nothing where a region cannot be merged so.
    static std::optional<CapturedSurfaces> of(const MergedGroup& group, const MergeRegion& region);
    void compose(LeafList& leaves) const;

private:
    CapturedSurfaces(const MergedGroup& group, const MergeRegion& region,
                     std::vector<CaptureSet> sets)
        : _group(group), _region(region), _sets(std::move(sets))
    {
    }
    int slotCount() const { return _sets.back().firstSlot + _sets.back().slotCount; }
    std::vector<std::size_t> surfacesOf(const CaptureSet& set) const;
    void addStep(CaptureLeaf::Step step, int slot, bool conditional, LeafList& leaves) const;
    void addCaptures(const CaptureSet& set, LeafList& leaves) const;
    void addVolume(LeafList& leaves) const;
    void addRest(const CaptureSet& set, LeafList& leaves) const;
    void addDepths(LeafList& leaves) const;

    const MergedGroup& _group;
    const MergeRegion& _region;
    const std::vector<CaptureSet> _sets; ///< of the region's surfaces
};

} // namespace render
} // namespace osgVolumizer
