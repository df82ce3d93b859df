#pragma once

#include "../context/RenderDataAccess.h"
#include "../textures/TableTextures.h"
#include "FrameTimes.h"
#include "SamplingChoices.h"

namespace osgVolumizer {
namespace render {

/// What is kept with a VolumeAppearance: its tables, and what an error tolerance and a frame time
/// come to.
class AppearanceData : public RenderData
{
public:
    TableTextures tables;
    SamplingChoices choices;
    FrameTimes frameTimes;

    void resizeGLObjectBuffers(unsigned int maximum) override
    {
        tables.resizeGLObjectBuffers(maximum);
    }
    void releaseGLObjects(osg::State* state) const override { tables.releaseGLObjects(state); }
};

} // namespace render
} // namespace osgVolumizer
