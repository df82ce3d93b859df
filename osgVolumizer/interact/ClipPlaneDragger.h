#pragma once

#include "VolumeHandles.h"

#include <osg/BoundingBox>
#include <osg/ClipPlane>

#include <optional>

namespace osgVolumizer {

/// Moves one plane of an osg::ClipNode, which cuts volumes as it cuts geometry. Dragger 0: an arrow
/// moves it along its normal, rings turn it. The group goes beside the ClipNode, or into it: planes
/// do not cut handles.
class OSGVOLUMIZER_EXPORT ClipPlaneDragger : public VolumeHandles
{
public:
    /// Expects a plane. \param about the box in the middle of which, and as large as which, it is
    /// shown
    ClipPlaneDragger(osg::ClipPlane* plane, const osg::BoundingBoxd& about);

    osg::ClipPlane* getPlane() const { return _plane.get(); }

protected:
    ~ClipPlaneDragger() override = default;

    void place() override;
    /// Refuses (VALUE_INVALID) what is not finite.
    ReportedStatus move(unsigned dragger) override;
    DragHistory::Restore remember() override;

private:
    const osg::ref_ptr<osg::ClipPlane> _plane;
    const double _size;
    osg::Vec3d _middle;
    std::optional<osg::Vec4d> _shown;
};

} // namespace osgVolumizer
