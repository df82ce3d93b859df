#pragma once

#include <osg/State>
#include <osg/Viewport>

#include <optional>

namespace osgVolumizer {
namespace render {

/// The window depth of a pixel of a viewport, 0 to 1, in the buffer that is drawn to; nothing
/// outside the viewport, or where it cannot be read. In the draw thread.
std::optional<double> readDepth(osg::State& state, const osg::Viewport& viewport, double x,
                                double y);

} // namespace render
} // namespace osgVolumizer
