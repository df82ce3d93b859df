#pragma once

#include "Probe.h"
#include "VolumeHandles.h"

#include <functional>

namespace osg {
class Geometry;
}

namespace osgVolumizer {

/// Probes a volume where its handles are: along a line, or at a point. Points move across the line
/// of sight. The group goes beside the geometry, whose frame its places are in.
/// Draggers: 0, 1: the ends of the line; 2: its middle, which moves both. Of a point: 0.
class OSGVOLUMIZER_EXPORT ProbeDragger : public VolumeHandles
{
public:
    /// Told what is found, or why there is nothing to be, with each move.
    using Callback = std::function<void(const Result<VoxelProbe>&)>;

    /// Expects a geometry and an appearance, which need not be above it, and a radius above 0.
    /// \param radius of the handles, object units
    ProbeDragger(const VolumeGeometry* geometry, const VolumeAppearance* appearance,
                 const osg::Vec3d& start, const osg::Vec3d& end, double radius);
    ProbeDragger(const VolumeGeometry* geometry, const VolumeAppearance* appearance,
                 const osg::Vec3d& point, double radius);

    void setCallback(Callback callback) { _callback = std::move(callback); }
    void setOptions(const ProbeOptions& options) { _options = options; }
    const ProbeOptions& getOptions() const { return _options; }

    /// The same place twice, for a point. Refuses (VALUE_INVALID) what is not finite, a line
    /// without length, and one in place of a point.
    ReportedStatus setSegment(const osg::Vec3d& start, const osg::Vec3d& end);
    const osg::Vec3d& getStart() const { return _start; }
    const osg::Vec3d& getEnd() const { return _end; }
    bool isPoint() const { return _point; }

    /// What is found at present. At a point that is the voxel about it, with the filtered value
    /// exactly there: it is probed by a line of a millionth of a voxel, and one that lies on the
    /// border of two voxels may give both.
    Result<VoxelProbe> probeNow() const;

protected:
    ~ProbeDragger() override;

    void place() override;
    ReportedStatus move(unsigned dragger) override;
    DragHistory::Restore remember() override;

private:
    void makeHandles();

    const osg::ref_ptr<const VolumeGeometry> _geometry;
    const osg::ref_ptr<const VolumeAppearance> _appearance;
    const bool _point;
    const double _radius;
    osg::Vec3d _start, _end;
    ProbeOptions _options;
    Callback _callback;
    osg::ref_ptr<osg::Geometry> _line; // about _start
    osg::ref_ptr<osg::Group> _linePlace;
};

} // namespace osgVolumizer
