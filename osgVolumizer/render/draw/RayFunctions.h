#pragma once

#include "../../VolumeAppearance.h"

#include <osg/GL>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What rendering knows of a ray function.
///
/// Its shader defines `march()`, where SLAB is defined: what a segment of the ray leaves in a
/// brick; `slice()`, where SLICE is defined: the same of a layer about one place; and, if it
/// gathers and RESOLVE is defined, `gatheredEntry()`: where the table is asked for what was
/// gathered. They take the place of `#pragma ray_function` in slab.glsl, slice.frag.glsl
/// and resolve.frag.glsl.
struct RayFunctionRow
{
    VolumeAppearance::RayFunction function;
    /// Files of shaders/, in the order in which they are compiled: its own, and what it shares.
    std::vector<std::string> shaders;

    /// Light is emitted and absorbed along the ray. Then the appearance's lookup decides when the
    /// table is asked, and sampling can be chosen for an error tolerance.
    bool integratesLight = false;
    bool needsSlabs = false;        ///< cannot be drawn from slices
    bool needsOneComponent = false; ///< cannot be had of colours
    bool showsIsoValueOnly = false; ///< cells that do not hold the iso-value show nothing

    /// Values are gathered from all bricks, in any order, in a target of their own that begins with
    /// `emptyValue` and blends by `blendEquation` with factors of one; then they are drawn at once.
    /// Else each brick's colours are blended over what is behind.
    bool gathers = false;
    GLenum blendEquation = GL_NONE;
    float emptyValue = 0.0f;
};

/// The row of a ray function.
const RayFunctionRow& rowOf(VolumeAppearance::RayFunction function);

/// What its shaders' files hold, one after another.
std::string rayShaderSource(VolumeAppearance::RayFunction function);

} // namespace render
} // namespace osgVolumizer
