#pragma once

#include "ContextResources.h"

namespace osgVolumizer {
namespace render {

/// Draws some thousand filtered and blended values, and compares them with what they should be.
/// Expects a context that volumes can be drawn in, current; leaves its state as it was, but for
/// errors of before, which are taken off. Where it cannot, says so once, and nothing is known.
Precision measurePrecision(osg::State& state, ContextResources& resources);

} // namespace render
} // namespace osgVolumizer
