#pragma once

#include "../context/RenderDataAccess.h"
#include "../textures/TableTextures.h"
#include "FrameTimes.h"
#include "SamplingChoices.h"

#include <atomic>
#include <memory>

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
    /// Of the lights of any view that it was drawn in, and 1 at least.
    std::shared_ptr<std::atomic<double>> brightness = std::make_shared<std::atomic<double>>(1.0);

    void resizeGLObjectBuffers(unsigned int maximum) override
    {
        tables.resizeGLObjectBuffers(maximum);
    }
    void releaseGLObjects(osg::State* state) const override { tables.releaseGLObjects(state); }
};

} // namespace render
} // namespace osgVolumizer
