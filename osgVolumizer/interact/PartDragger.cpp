#include "PartDragger.h"

#include "private/HandleShapes.h"

namespace osgVolumizer {

namespace {

// Of the children, in the transform's own frame.
osg::BoundingSphere boundWithin(const osg::MatrixTransform& part)
{
    osg::BoundingSphere bound;
    for (unsigned i = 0; i < part.getNumChildren(); ++i)
        bound.expandBy(part.getChild(i)->getBound());
    return bound;
}

} // namespace

PartDragger::PartDragger(osg::MatrixTransform* part) : _part(part)
{
    const osg::BoundingSphere bound = boundWithin(*part);
    if (bound.valid() && bound.radius() > 0.0f) {
        _place = handleShapes::ballPlace(bound.center(), bound.radius());
        _unplace.invert(_place);
    }
    addDragger(handleShapes::makePartDragger());
    PartDragger::place();
}

void PartDragger::place()
{
    const osg::Matrixd& matrix = _part->getMatrix();
    if (_shown && *_shown == matrix) return;
    getDragger(0)->setMatrix(_place * matrix);
    _shown = matrix;
}

ReportedStatus PartDragger::move(unsigned)
{
    const osg::Matrixd wanted = _unplace * getDragger(0)->getMatrix();
    if (!wanted.valid()) {
        _shown.reset();
        return reported({ErrorCode::VALUE_INVALID, "a part is dragged out of all numbers"});
    }
    _part->setMatrix(wanted);
    _shown = wanted;
    return {};
}

DragHistory::Restore PartDragger::remember()
{
    return [part = _part, kept = osg::Matrixd(_part->getMatrix())] { part->setMatrix(kept); };
}

} // namespace osgVolumizer
