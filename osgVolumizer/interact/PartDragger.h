#pragma once

#include "VolumeHandles.h"

#include <osg/MatrixTransform>
#include <osg/Matrixd>

#include <optional>

namespace osgVolumizer {

/// Moves and turns a part of a model by its own transform: a jaw against its skull, say, a
/// MatrixTransform between a VolumeAppearance and some of its VolumeGeometry, which shares voxels
/// and look with the rest. Dragger 0: arrows along the part's axes, rings to turn it by. The group
/// goes beside the transform: below the same parent.
class OSGVOLUMIZER_EXPORT PartDragger : public VolumeHandles
{
public:
    /// Expects a transform, whose matrix has an inverse, and whose children, if there are any, say
    /// where its handles are and how large.
    explicit PartDragger(osg::MatrixTransform* part);

    osg::MatrixTransform* getPart() const { return _part.get(); }

protected:
    ~PartDragger() override = default;

    void place() override;
    /// Refuses (VALUE_INVALID) what is not finite.
    ReportedStatus move(unsigned dragger) override;
    DragHistory::Restore remember() override;

private:
    const osg::ref_ptr<osg::MatrixTransform> _part;
    osg::Matrixd _place, _unplace; // from the handles' frame to the part's, and back
    std::optional<osg::Matrixd> _shown;
};

} // namespace osgVolumizer
