#pragma once

#include "ContextResources.h"

namespace osgVolumizer {
namespace render {

/// Buffers that are drawn into instead of the framebuffer: they are made here, and nowhere else.
/// Each function makes what is missing, or too small, or of another format, and returns whether it
/// is there: what a card refuses is not asked for again in that context at that size (see
/// Allocation.h). They leave bindings of framebuffers undefined. Call in the draw thread.

/// The copy of the opaque scene's depth, for window coordinates below width and height.
bool ensureOpaqueDepth(osg::State& state, AccumulationBuffers& buffers, int width, int height,
                       GLenum depthFormat);
/// The target, as large as the copy of depth: in the first of the colour formats that the card has
/// memory for.
bool ensureTarget(osg::State& state, AccumulationBuffers& buffers,
                  const std::vector<GLenum>& colorFormats);
/// The depth of surfaces that split segments, as large as the copy of depth.
bool ensureLayerDepth(osg::State& state, AccumulationBuffers& buffers);
/// The buffers of sorted layers, with the target's colour.
bool ensureLayers(osg::State& state, AccumulationBuffers& buffers);
/// The buffers of captured surfaces, as large as the target, with at least so many slots.
bool ensureCapture(osg::State& state, const AccumulationBuffers& accumulation,
                   CaptureBuffers& buffers, int slotCount);
/// Where values of rays are gathered.
bool ensureRays(osg::State& state, RayBuffers& buffers, int width, int height);

/// The name of a texture that was made.
GLuint textureName(const osg::State& state, const osg::Texture& texture);
/// Attaches a depth texture, and its stencil values if it has any, to the framebuffer bound.
void attachDepth(osg::GLExtensions& gl, GLuint texture, GLenum depthFormat);

} // namespace render
} // namespace osgVolumizer
