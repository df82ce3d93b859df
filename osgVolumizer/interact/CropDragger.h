#pragma once

#include "VolumeHandles.h"

#include <osg/BoundingBox>

#include <optional>

namespace osgVolumizer {

class VolumeGeometry;

/// Crops by handles: makes a VolumeGeometry the box that they show. What it was else than a box
/// before the first drag, tetrahedra, voxel coordinates and colours of vertices, undo brings back.
/// Dragger 0: tabs on the faces move edges and corners, faces slide in their plane. The group goes
/// beside the geometry.
class OSGVOLUMIZER_EXPORT CropDragger : public VolumeHandles
{
public:
    /// Expects a geometry.
    explicit CropDragger(VolumeGeometry* geometry);

    VolumeGeometry* getGeometry() const { return _geometry.get(); }

protected:
    ~CropDragger() override;

    void place() override;
    ReportedStatus move(unsigned dragger) override;
    DragHistory::Restore remember() override;

private:
    const osg::ref_ptr<VolumeGeometry> _geometry;
    std::optional<unsigned> _shown; // the geometry's modified count
};

} // namespace osgVolumizer
