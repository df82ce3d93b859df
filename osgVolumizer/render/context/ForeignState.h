#pragma once

#include <osg/State>

namespace osgVolumizer {
namespace render {

/// Takes out of the way, for as long as it lives, what attributes of the scene may have set that
/// would change what volumes and passes over the screen draw, and that state sets cannot protect
/// against without errors in contexts that lack it: samplers, divisors of vertex attributes,
/// clamped colours, blending that is off for one buffer. OSG applies its own again afterwards.
/// Costs nothing where the scene has none of them.
class ForeignStateScope
{
public:
    /// \param blends whether what is drawn needs blending
    ForeignStateScope(osg::State& state, bool blends);
    ForeignStateScope(const ForeignStateScope&) = delete;
    ForeignStateScope& operator=(const ForeignStateScope&) = delete;
    ~ForeignStateScope();

private:
    osg::GLExtensions& _gl;
    bool _blendWasOff = false;
};

/// To be called at the end of every leaf of ours: what OSG applies in the frame of the first leaf
/// that it comes to (clip planes, lights and texture coordinates that are attributes of a state
/// set) is applied again for the next one, since our frames are none of the scene's.
void reapplyInNextFrame(osg::State& state);

} // namespace render
} // namespace osgVolumizer
