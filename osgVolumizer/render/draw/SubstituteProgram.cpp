#include "SubstituteProgram.h"

#include "FusedVolumes.h"
#include "VolumeProgram.h"

namespace osgVolumizer {
namespace render {

SubstituteProgram::SubstituteProgram(osg::State& state, const AccumulationBuffers& buffers,
                                     const VolumePart& part)
    : _state(state)
{
    const ProgramFeatures& features = part.features;
    if (!features.needsSortedSurfaces() || buffers.sortedSurfaces[0]) return;
    ProgramFeatures plain = features;
    plain.slotCount = 0;
    plain.ranked = false;
    _before = state.getLastAppliedAttribute(osg::StateAttribute::PROGRAM);
    _set = volumeStateSet(plain, membersOf(part));
    state.applyAttribute(_set->getAttribute(osg::StateAttribute::PROGRAM));
    state.applyAttribute(_set->getAttribute(osg::StateAttribute::BLENDFUNC));
    state.haveAppliedAttribute(osg::StateAttribute::BLENDFUNC);
}

SubstituteProgram::~SubstituteProgram()
{
    if (_set && _before) _state.applyAttribute(_before);
}

} // namespace render
} // namespace osgVolumizer
