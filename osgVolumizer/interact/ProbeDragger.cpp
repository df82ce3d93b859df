#include "ProbeDragger.h"

#include "../VolumeAppearance.h"
#include "../VolumeGeometry.h"
#include "private/HandleShapes.h"

#include <osg/MatrixTransform>
#include <osg/observer_ptr>

#include <cmath>

namespace osgVolumizer {

ProbeDragger::ProbeDragger(const VolumeGeometry* geometry, const VolumeAppearance* appearance,
                           const osg::Vec3d& start, const osg::Vec3d& end, double radius)
    : _geometry(geometry), _appearance(appearance), _point(false), _radius(radius), _start(start),
      _end(end), _line(handleShapes::makeLines()), _linePlace(new osg::MatrixTransform)
{
    makeHandles();
    _linePlace->setDataVariance(osg::Object::DYNAMIC); // not to be flattened into the line
    _linePlace->addChild(_line);
    addChild(_linePlace);
    ProbeDragger::place();
}

ProbeDragger::ProbeDragger(const VolumeGeometry* geometry, const VolumeAppearance* appearance,
                           const osg::Vec3d& point, double radius)
    : _geometry(geometry), _appearance(appearance), _point(true), _radius(radius), _start(point),
      _end(point)
{
    makeHandles();
    ProbeDragger::place();
}

ProbeDragger::~ProbeDragger() = default;

void ProbeDragger::makeHandles()
{
    addDragger(handleShapes::makePointDragger());
    if (_point) return;
    addDragger(handleShapes::makePointDragger());
    addDragger(handleShapes::makePointDragger(handleShapes::OUTLINE_COLOR));
}

ReportedStatus ProbeDragger::setSegment(const osg::Vec3d& start, const osg::Vec3d& end)
{
    const double length = (end - start).length();
    if (!std::isfinite(length) || !std::isfinite(start.length()))
        return reported({ErrorCode::VALUE_INVALID, "a probe is to be at a place not finite"});
    if (_point && length > 0.0)
        return reported({ErrorCode::VALUE_INVALID, "a probe at a point is to be at two places"});
    if (!_point && !(length > 0.0))
        return reported({ErrorCode::VALUE_INVALID, "a probe along a line is to have no length"});
    _start = start;
    _end = end;
    return {};
}

void ProbeDragger::place()
{
    if (_point) return getDragger(0)->setMatrix(handleShapes::ballPlace(_start, _radius));
    const osg::Vec3d places[] = {_start, _end, (_start + _end) * 0.5};
    for (unsigned i = 0; i < 3; ++i)
        getDragger(i)->setMatrix(handleShapes::ballPlace(places[i], _radius));
    const osg::Matrixd lineMatrix = osg::Matrixd::translate(_start);
    auto& transform = static_cast<osg::MatrixTransform&>(*_linePlace);
    const auto& drawn = static_cast<const osg::Vec3Array&>(*_line->getVertexArray());
    const osg::Vec3 end = _end - _start;
    if (drawn.size() == 2 && drawn[1] == end && transform.getMatrix() == lineMatrix) return;
    transform.setMatrix(lineMatrix);
    handleShapes::setLines(*_line, {osg::Vec3d(), _end - _start});
}

ReportedStatus ProbeDragger::move(unsigned dragger)
{
    const osg::Vec3d now = getDragger(dragger)->getMatrix().getTrans();
    osg::Vec3d start = _start, end = _end;
    const osg::Vec3d half = (_end - _start) * 0.5;
    if (_point || dragger == 0) start = now;
    if (_point || dragger == 1) end = now;
    if (dragger == 2) start = now - half, end = now + half;
    const ReportedStatus status = setSegment(start, end);
    if (!status) return status;
    place();
    if (_callback) _callback(probeNow());
    return {};
}

DragHistory::Restore ProbeDragger::remember()
{
    // A history that this holds must not hold this.
    return [self = osg::observer_ptr<ProbeDragger>(this), start = _start, end = _end] {
        osg::ref_ptr<ProbeDragger> probe;
        if (!self.lock(probe)) return;
        probe->setSegment(start, end);
        if (probe->_callback) probe->_callback(probe->probeNow());
    };
}

Result<VoxelProbe> ProbeDragger::probeNow() const
{
    if (!_point) return probe(*_geometry, *_appearance, _start, _end, _options);
    const Voxels* voxels = _appearance->getVoxels();
    const double shortest = 1e-6 * (voxels ? voxels->getMeanSpacing() : 1.0);
    const osg::Vec3d half(0.5 * shortest, 0.0, 0.0);
    return probe(*_geometry, *_appearance, _start - half, _start + half, _options);
}

} // namespace osgVolumizer
