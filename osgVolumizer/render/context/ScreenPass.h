#pragma once

#include "ContextResources.h"

#include <osg/StateSet>
#include <osg/Stencil>

#include <glm/vec4.hpp>

#include <string>

namespace osgVolumizer {
namespace render {

/// State that holds against every state around it, overriding or not.
constexpr unsigned FORCE_ON =
    osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
constexpr unsigned FORCE_OFF =
    osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;

/// The state of a pass over all pixels of a rectangle, one fragment each: every test and blending
/// off, whatever the scene's state. The shader writes either colour or depth; `code` goes before
/// it.
osg::ref_ptr<osg::StateSet> screenState(const std::string& fragmentShader, bool writeDepth,
                                        const std::string& code = {});

/// Draws such a pass to a window rectangle (x, y, width, height) with the program in force.
void drawScreen(osg::State& state, ContextResources& resources, const glm::ivec4& area);

/// The state of a leaf that clears depth and stencil: both may be written. Shared.
osg::ref_ptr<osg::StateSet> clearState();
/// Clears the buffers `what` of a window rectangle, stencil to 0.
void clearArea(const glm::ivec4& area, GLbitfield what);
/// Counts a pixel's fragments; those pass for which `function` holds of reference and count.
osg::ref_ptr<osg::Stencil> countingStencil(osg::Stencil::Function function, int reference);
/// Redirects drawing, not reading.
void bindFramebuffer(osg::State& state, GLuint name);
constexpr GLenum WAIT_FOR_QUERY = 0x8E13; ///< GL_QUERY_WAIT

/// Sets a uniform of the program in force.
void setUniform(osg::State& state, const char* name, int value);

} // namespace render
} // namespace osgVolumizer
