#pragma once

#include "Renderer.h"

namespace osgVolumizer {
namespace bench {

/// VTK's GPU ray caster, or its fixed-point CPU ray caster. Both render to a float target of ours
/// in a hidden window, so they need an X server (Xvfb will do).
RendererPtr makeVtkRenderer(bool gpu);

} // namespace bench
} // namespace osgVolumizer
