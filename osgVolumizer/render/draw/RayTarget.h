#pragma once

#include "TargetScope.h"
#include "VolumeDrawable.h"

#include <osg/RenderInfo>

namespace osgVolumizer {
namespace render {

struct ContextResources;

/// Gathers what all bricks of a volume leave of each pixel's ray, in 32-bit floats, in any order:
/// the highest or lowest value, or sums. From construction on drawing is redirected; resolve()
/// looks the values up and draws them over what was there before, at once. Then everything is
/// as it was found. To be used in the draw thread, within one drawable.
class RayTarget
{
public:
    RayTarget(osg::State& state, ContextResources& resources, const ProgramFeatures& features,
              const glm::ivec4& viewport);
    RayTarget(const RayTarget&) = delete;
    RayTarget& operator=(const RayTarget&) = delete;

    /// False where the card has no memory for the target: then nothing may be drawn.
    bool made() const { return _made; }
    void resolve(const VolumeLook& look);

private:
    osg::State& _state;
    osg::GLExtensions& _gl;
    ContextResources& _resources;
    const ProgramFeatures& _features;
    glm::ivec4 _viewport;
    TargetScope _scope;
    bool _made = false;
};

} // namespace render
} // namespace osgVolumizer
