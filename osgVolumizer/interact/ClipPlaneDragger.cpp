#include "ClipPlaneDragger.h"

#include "private/HandleShapes.h"

#include <cmath>

namespace osgVolumizer {

ClipPlaneDragger::ClipPlaneDragger(osg::ClipPlane* plane, const osg::BoundingBoxd& about)
    : _plane(plane), _size(about.valid() ? 2.0 * about.radius() / std::sqrt(3.0) : 1.0),
      _middle(about.valid() ? osg::Vec3d(about.center()) : osg::Vec3d())
{
    _plane->setDataVariance(osg::Object::DYNAMIC);
    addDragger(handleShapes::makePlaneDragger());
    ClipPlaneDragger::place();
}

void ClipPlaneDragger::place()
{
    const osg::Vec4d plane = _plane->getClipPlane();
    // One without a direction cuts all or nothing, and is nowhere.
    const bool somewhere = osg::Vec3d(plane.x(), plane.y(), plane.z()).length() > 0.0;
    getDragger(0)->setNodeMask(somewhere ? ~0u : 0u);
    if (!somewhere || (_shown && *_shown == plane)) return;
    getDragger(0)->setMatrix(handleShapes::planePlace(plane, _middle, _size));
    _shown = plane;
}

ReportedStatus ClipPlaneDragger::move(unsigned)
{
    const osg::Matrixd matrix = getDragger(0)->getMatrix();
    const osg::Vec4d wanted = handleShapes::planeOf(matrix);
    if (!std::isfinite(wanted.length())) {
        _shown.reset();
        return reported({ErrorCode::VALUE_INVALID, "a clip plane is dragged out of all numbers"});
    }
    _plane->setClipPlane(wanted);
    _middle = matrix.getTrans();
    _shown = wanted;
    return {};
}

DragHistory::Restore ClipPlaneDragger::remember()
{
    return [plane = _plane, kept = _plane->getClipPlane()] { plane->setClipPlane(kept); };
}

} // namespace osgVolumizer
