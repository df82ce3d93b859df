#pragma once

#include "LatticeDeformer.h"
#include "VolumeHandles.h"

#include <optional>

namespace osg {
class Geometry;
}

namespace osgVolumizer {

/// Bends a volume by handles: a ball at each control point of a lattice, which moves across the
/// line of sight, and lines between neighbours. Where a drag would fold the lattice over, the ball
/// stays. Dragger i is control point i. The group goes beside the geometry.
class OSGVOLUMIZER_EXPORT LatticeDragger : public VolumeHandles
{
public:
    /// Expects a lattice.
    explicit LatticeDragger(LatticeDeformer* lattice);

    LatticeDeformer* getLattice() const { return _lattice.get(); }

protected:
    ~LatticeDragger() override;

    void place() override;
    ReportedStatus move(unsigned dragger) override;
    DragHistory::Restore remember() override;

private:
    const osg::ref_ptr<LatticeDeformer> _lattice;
    osg::ref_ptr<osg::Geometry> _lines; // about the first point at rest
    std::optional<unsigned> _shown;     // the lattice's modified count
};

} // namespace osgVolumizer
