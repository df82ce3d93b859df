#include "SubstituteProgram.h"

#include "VolumeProgram.h"

namespace osgVolumizer {
namespace render {

SubstituteProgram::SubstituteProgram(osg::State& state, const AccumulationBuffers& buffers,
                                     const ProgramFeatures& features)
    : _state(state)
{
    if (!features.needsSortedSurfaces() || buffers.sortedSurfaces[0]) return;
    ProgramFeatures plain = features;
    plain.slotCount = 0;
    plain.ranked = false;
    _before = state.getLastAppliedAttribute(osg::StateAttribute::PROGRAM);
    _set = volumeStateSet(plain);
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
