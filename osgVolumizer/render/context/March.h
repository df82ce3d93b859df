#pragma once

#include "ContextResources.h"

#include <optional>
#include <string>

namespace osgVolumizer {
namespace render {

/// By what the rays of pixels are marched: the fragments of what is rasterised, or a compute shader
/// over the same pixels.
enum class March
{
    FRAGMENTS,
    COMPUTE
};

/// What one march through a small picture takes: seconds on the card; 0 where that is not known.
struct MarchTimes
{
    double fragments = 0.0, compute = 0.0;
};

/// What a march is taken for compute shaders instead of fragments: a fifth of the time less.
March fasterMarch(const MarchTimes& times);

/// The march that is asked for, or else the faster one in the current context, measured when this
/// is first called there. FRAGMENTS below OpenGL 4.3, and where refuseCompute() was called. In the
/// draw thread.
March marchOf(osg::State& state, ContextResources& resources);
/// Says why a context does not march by compute shaders, and does without from now on.
void refuseCompute(ContextResources& resources, const std::string& reason);

/// Asks for one in all contexts from now on, or for the faster one. Thread safe.
void setMarch(std::optional<March> march);
/// What is asked for: at first what the environment variable OSGVOLUMIZER_MARCH ("fragments" or
/// "compute") says, or nothing.
std::optional<March> askedMarch();

/// The header of a compute shader: version, COMPUTE, and the image unit of its target.
std::string computeHeader(const osg::State& state);
/// Runs the compute program in force over the pixels of its `area`, whose size this is, with a
/// target of a format in its image unit. What follows sees what it wrote.
void runCompute(osg::State& state, const osg::Texture& target, GLenum format, int width,
                int height);

} // namespace render
} // namespace osgVolumizer
