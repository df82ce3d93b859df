#pragma once

#include "AccumulationBuffers.h"
#include "FusedVolumes.h"

#include "../../core/sampling/View.h"

#include <osg/Program>
#include <osg/RenderInfo>

#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace render {

/// What the members of a march are drawn with.
struct FusedDrawing
{
    osg::RenderInfo& renderInfo;
    ContextResources& resources;
    const VolumePart& part;   ///< whose `fused` is drawn
    glm::dmat4 projection;    ///< to the usual clip space
    glm::dvec4 viewport{0.0}; ///< of the rays
};

/// Gives a program that marches several volumes the textures and uniforms of each. False where the
/// card has too few texture units, or refuses a texture.
bool setMembers(const FusedDrawing& drawing, const osg::Program::PerContextProgram& program);

/// Draws the members one after the other instead, far to near, from a mesh in device coordinates
/// that is bound. Right where they do not overlap.
void drawMembersApart(const FusedDrawing& drawing, const BrickBatch& triangles);

} // namespace render
} // namespace osgVolumizer
