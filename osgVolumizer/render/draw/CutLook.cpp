#include "CutLook.h"

#include "../../Error.h"
#include "../context/Allocation.h"
#include "../context/ReportOnce.h"

namespace osgVolumizer {
namespace render {

void setCut(const Uniforms& uniforms, const CutLook& cut)
{
    uniforms.set("cutFromVolume", cut.fromVolume);
    uniforms.set("cutPlaneCount", static_cast<int>(cut.planes.size()));
    uniforms.set("cutPlanes", cut.planes);
    uniforms.set("cutShapeCount", static_cast<int>(cut.centers.size()));
    uniforms.set("cutCenters", cut.centers);
    uniforms.set("cutHalfSizes", cut.halfSizes);
    uniforms.set("cutSharpness", cut.sharpness);
    uniforms.set("cutFieldScale", cut.fieldScale);
    uniforms.set("cutFieldOffset", cut.fieldOffset);
}

bool applyCutField(osg::State& state, const CutLook& cut, unsigned unit)
{
    if (!cut.field) return true;
    if (applyAllocated(state, AllocationRequest::CELLS, *cut.field, unit)) return true;
    reportOnce({ErrorCode::TOO_LARGE,
                "the grid of a cut is refused by the graphics card; the volume is not drawn"});
    return false;
}

} // namespace render
} // namespace osgVolumizer
