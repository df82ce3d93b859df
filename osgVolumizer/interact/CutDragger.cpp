#include "CutDragger.h"

#include "private/HandleShapes.h"

#include <cmath>
#include <string>

namespace osgVolumizer {

namespace {

osg::ref_ptr<osgManipulator::Dragger> draggerFor(CutRegion::Kind kind)
{
    if (kind == CutRegion::BOX) return handleShapes::makeBoxDragger();
    if (kind == CutRegion::SPHERE) return handleShapes::makeSphereDragger();
    return handleShapes::makePlaneDragger();
}

bool sameRegion(const CutRegion& a, const CutRegion& b)
{
    return a.getKind() == b.getKind() && a.isComplement() == b.isComplement() &&
           a.getPlane() == b.getPlane() && a.getBox()._min == b.getBox()._min &&
           a.getBox()._max == b.getBox()._max && a.getCenter() == b.getCenter() &&
           a.getRadius() == b.getRadius();
}

CutRegion regionFrom(CutRegion::Kind kind, const osg::Matrixd& matrix)
{
    if (kind == CutRegion::BOX) return CutRegion::box(handleShapes::boxOf(matrix));
    if (kind == CutRegion::SPHERE)
        return CutRegion::sphere(matrix.getTrans(), handleShapes::radiusOf(matrix));
    return CutRegion::halfSpace(handleShapes::planeOf(matrix));
}

} // namespace

Result<osg::ref_ptr<CutDragger>> CutDragger::create(VolumeCut* cut, unsigned region,
                                                    const osg::BoundingBoxd& about)
{
    if (region >= cut->getNumRegions())
        return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                      "handles for a cut: there is no region " + std::to_string(region) + ", but " +
                          std::to_string(cut->getNumRegions()) + " of them",
                      region);
    const CutRegion::Kind kind = cut->getRegion(region).getKind();
    if (kind == CutRegion::SURFACE || kind == CutRegion::MASK)
        return Status(ErrorCode::NOT_SUPPORTED, "handles for a cut: surfaces and masks have none");
    return osg::ref_ptr<CutDragger>(new CutDragger(cut, region, about));
}

CutDragger::CutDragger(VolumeCut* cut, unsigned region, const osg::BoundingBoxd& about)
    : _cut(cut), _number(region), _kind(cut->getRegion(region).getKind()),
      _size(about.valid() ? 2.0 * about.radius() / std::sqrt(3.0) : 1.0),
      _middle(about.valid() ? osg::Vec3d(about.center()) : osg::Vec3d())
{
    addDragger(draggerFor(_kind));
    CutDragger::place();
}

const CutRegion* CutDragger::region() const
{
    if (_number >= _cut->getNumRegions()) return nullptr;
    const CutRegion& region = _cut->getRegion(_number);
    return region.getKind() == _kind ? &region : nullptr;
}

void CutDragger::place()
{
    const CutRegion* present = region();
    osgManipulator::Dragger& dragger = *getDragger(0);
    dragger.setNodeMask(present ? ~0u : 0u);
    if (!present || (_shown && sameRegion(*_shown, *present))) return;
    if (_kind == CutRegion::BOX)
        dragger.setMatrix(handleShapes::boxPlace(present->getBox()));
    else if (_kind == CutRegion::SPHERE)
        dragger.setMatrix(handleShapes::spherePlace(present->getCenter(), present->getRadius()));
    else
        dragger.setMatrix(handleShapes::planePlace(present->getPlane(), _middle, _size));
    _shown = *present;
}

ReportedStatus CutDragger::move(unsigned)
{
    _shown.reset();
    const CutRegion* present = region();
    if (!present) return {};
    const osg::Matrixd matrix = getDragger(0)->getMatrix();
    CutRegion wanted = regionFrom(_kind, matrix);
    if (present->isComplement()) wanted = wanted.complement();
    const ReportedStatus status = _cut->setRegion(_number, wanted);
    if (!status) return status;
    _middle = matrix.getTrans();
    if (_kind == CutRegion::SPHERE)
        place(); // as large along the other axes
    else
        _shown = wanted;
    return {};
}

DragHistory::Restore CutDragger::remember()
{
    const CutRegion* present = region();
    if (!present) return {};
    return [cut = _cut, number = _number, kept = *present] { cut->setRegion(number, kept); };
}

} // namespace osgVolumizer
