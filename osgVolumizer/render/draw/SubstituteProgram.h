#pragma once

#include "AccumulationBuffers.h"
#include "VolumePart.h"

#include <osg/State>
#include <osg/StateSet>

namespace osgVolumizer {
namespace render {

/// Takes the place of a program whose surfaces the card has no memory for: the volume is drawn
/// without them, which come after it. Found in the frame that asks for the memory; the next ones
/// are composed without. Call in the draw thread.
class SubstituteProgram
{
public:
    SubstituteProgram(osg::State& state, const AccumulationBuffers& buffers,
                      const VolumePart& part);
    SubstituteProgram(const SubstituteProgram&) = delete;
    SubstituteProgram& operator=(const SubstituteProgram&) = delete;
    ~SubstituteProgram();

    /// Of the segments between ranks the first stands for all.
    bool isDrawn(const VolumePart& part) const
    {
        return !_set || !part.features.ranked || part.rank == 0;
    }

private:
    osg::State& _state;
    osg::ref_ptr<osg::StateSet> _set; ///< null where nothing is substituted
    const osg::StateAttribute* _before = nullptr;
};

} // namespace render
} // namespace osgVolumizer
