// Where things are: clipping, viewports.

#include "StateRow.h"

#include <osg/ClipControl>
#include <osg/GL>
#include <osg/Viewport>
#include <osg/ViewportIndexed>

#ifndef GL_DEPTH_CLAMP
#define GL_DEPTH_CLAMP 0x864F
#endif

namespace osgVolumizer {
namespace test {

namespace {

using osg::ClipControl;

} // namespace

std::vector<StateRow> spaceRows()
{
    return {
        {"ClipPlane, ClipNode", mode(GL_CLIP_PLANE0), Effect::AS_ON_GEOMETRY, true,
         "What lies behind the plane is neither read nor marched."},
        {"Viewport", with<osg::Viewport>(8, 6, 32, 34), Effect::AS_ON_GEOMETRY, true,
         "Drawn into the rectangle."},
        {"ViewportIndexed", with<osg::ViewportIndexed>(0u, 8, 6, 32, 34), Effect::AS_ON_GEOMETRY,
         true, "The same, of viewport 0. Surfaces under it are not merged with volumes.",
         Target::ANY, Scope::VOLUMES},
        {"ClipControl: origin",
         with<ClipControl>(ClipControl::UPPER_LEFT, ClipControl::NEGATIVE_ONE_TO_ONE),
         Effect::AS_ON_GEOMETRY, true,
         "Upside down. Surfaces are merged with volumes whose origin is theirs.", Target::ANY,
         Scope::VOLUMES},
        {"ClipControl: depth mode",
         with<ClipControl>(ClipControl::LOWER_LEFT, ClipControl::ZERO_TO_ONE),
         Effect::AS_ON_GEOMETRY, true, "Depths of rays are mapped as those of geometry.",
         Target::ANY, Scope::ELSEWHERE},
        {"`GL_DEPTH_CLAMP`", mode(GL_DEPTH_CLAMP), Effect::NONE, false,
         "A volume is drawn between the near and the far plane."},
    };
}

} // namespace test
} // namespace osgVolumizer
