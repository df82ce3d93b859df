#include "CropDragger.h"

#include "../VolumeGeometry.h"
#include "private/GlmToOsg.h"
#include "private/HandleShapes.h"

namespace osgVolumizer {

CropDragger::CropDragger(VolumeGeometry* geometry) : _geometry(geometry)
{
    addDragger(handleShapes::makeBoxDragger());
    CropDragger::place();
}

CropDragger::~CropDragger() = default;

void CropDragger::place()
{
    const unsigned count = _geometry->getModifiedCount();
    if (_shown && *_shown == count) return;
    const core::Box3d box = _geometry->getTetraSet()->bounds();
    getDragger(0)->setNodeMask(box.empty() ? 0u : ~0u);
    if (!box.empty())
        getDragger(0)->setMatrix(
            handleShapes::boxPlace({picking::toOsg(box.min), picking::toOsg(box.max)}));
    _shown = count;
}

ReportedStatus CropDragger::move(unsigned)
{
    _shown.reset();
    const ReportedStatus status =
        _geometry->setBox(handleShapes::boxOf(getDragger(0)->getMatrix()));
    if (status) _shown = _geometry->getModifiedCount();
    return status;
}

DragHistory::Restore CropDragger::remember()
{
    return
        [geometry = _geometry, kept = _geometry->getTetraSet()] { geometry->setTetraSet(*kept); };
}

} // namespace osgVolumizer
