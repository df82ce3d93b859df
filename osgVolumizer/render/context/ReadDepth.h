#pragma once

#include <osg/State>

#include <optional>

namespace osgVolumizer {
namespace render {

/// The window depth of a pixel of the viewport in force, 0 to 1, in the buffer that is drawn to;
/// nothing outside the viewport, or where it cannot be read. In the draw thread.
std::optional<double> readDepth(osg::State& state, double x, double y);

} // namespace render
} // namespace osgVolumizer
