#pragma once

#include "../CutRegion.h"
#include "../VolumeCut.h"
#include "VolumeHandles.h"

#include <osg/BoundingBox>

#include <optional>

namespace osgVolumizer {

/// Cuts by handles: a plane, a box or a sphere that is a region of a VolumeCut. Dragger 0:
///   - HALF_SPACE: an arrow moves the plane along its normal, rings turn it;
///   - BOX: tabs on the faces move edges and corners, faces slide in their plane;
///   - SPHERE: arrows move it, the boxes where they leave it change its radius.
/// Regions are in the frame of the voxels by themselves, so the group goes beside geometry that is
/// not deformed. A complement stays one. Where a program puts a region of another kind, or none, in
/// the place of this one there are no handles.
class OSGVOLUMIZER_EXPORT CutDragger : public VolumeHandles
{
public:
    /// Handles of a region that there is. INDEX_OUT_OF_RANGE for one that there is not;
    /// NOT_SUPPORTED for surfaces and masks. Expects a cut.
    /// \param about the box in the middle of which, and as large as which, a plane is shown
    static Result<osg::ref_ptr<CutDragger>> create(VolumeCut* cut, unsigned region,
                                                   const osg::BoundingBoxd& about);

    VolumeCut* getCut() const { return _cut.get(); }
    unsigned getRegionNumber() const { return _number; }

protected:
    CutDragger(VolumeCut* cut, unsigned region, const osg::BoundingBoxd& about);
    ~CutDragger() override = default;

    void place() override;
    ReportedStatus move(unsigned dragger) override;
    DragHistory::Restore remember() override;

private:
    const CutRegion* region() const;

    const osg::ref_ptr<VolumeCut> _cut;
    const unsigned _number;
    const CutRegion::Kind _kind;
    const double _size;              // of a plane's square
    osg::Vec3d _middle;              // of a plane's square, or near it
    std::optional<CutRegion> _shown; // what the handles stand for
};

} // namespace osgVolumizer
