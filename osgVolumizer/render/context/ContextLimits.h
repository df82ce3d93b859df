#pragma once

#include "../../core/Status.h"
#include "Precision.h"

#include <osg/State>

namespace osgVolumizer {
namespace render {

/// What a context can do, as far as it changes what is drawn.
struct ContextLimits
{
    double version = 0.0;      ///< of OpenGL
    bool floatTargets = false; ///< drawing into 16- and 32-bit float textures
    int textureUnits = 0;      ///< of a fragment shader
    int texture3DSize = 0;     ///< largest side of a 3D texture, texels; 0: there are none
    /// Float textures are filtered both faster and more exactly than others (llvmpipe, whose 8-bit
    /// path also rounds the result to 8 bits: an error of half a 255th of the type's range).
    bool filtersFloatsBest = false;
    /// Bits that shaders round the weights of filtering to, as most texture units round them,
    /// before what the context's own do; 0: they do not. For tests.
    int filterBits = 0;
    Precision precision; ///< in draw threads

    /// Whether volumes can be drawn at all; else what is missing.
    Status check() const;
};

/// Asks the current context; nothing is drawn, so that the precision is not known.
ContextLimits queryContextLimits(osg::State& state);
/// Adds what was measured, and what follows from it.
void setPrecision(ContextLimits& limits, const Precision& precision, const osg::State& state);

/// What OSG knows of a context, in any thread: largest side of a 3D texture, and texture units of a
/// fragment shader; 0 where it does not know yet.
int texture3DSizeOf(const osg::State& state);
int textureUnitsOf(const osg::State& state);
/// ContextLimits::filterBits of a context, in any thread.
int filterBitsOf(const osg::State& state);
/// That of all contexts whose hooks do not change it, from now on. Thread safe.
void setFilterBits(int bits);

} // namespace render
} // namespace osgVolumizer
