#pragma once

#include "../textures/DrawnBrick.h"
#include "../textures/TableTextures.h"

#include <osg/RenderInfo>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace render {

class Uniforms;

/// One brick of a volume that paints others, as one of those sees it.
struct Paint
{
    /// More bricks, or half-spaces of its region, than these are not painted with.
    static constexpr int MAXIMUM_COUNT = 4, MAXIMUM_PLANES = 8;

    DrawnBrick voxels;
    TableTexture table;
    glm::dmat4 fromFrame{1.0};                         ///< frame of the painted volume -> voxels
    glm::vec3 textureScale{1.0f}, textureOffset{0.0f}; ///< voxel -> texture coordinate
    glm::vec3 boxMin{0.0f}, boxMax{0.0f};              ///< voxels
    std::vector<glm::vec4> planes;                     ///< voxels; MAXIMUM_PLANES
    glm::vec2 valueToEntry{1.0f, 0.0f};
    bool rgba = false, nearest = false;
};

/// Shader code that multiplies colours by `count` paints: segments() and painted().
std::string paintSource(int count);
/// Textures and uniforms of paints, for a program that has that code; from `firstUnit` on, two
/// units each.
void setPaints(osg::RenderInfo& renderInfo, const ContextLimits& limits, const Uniforms& uniforms,
               const std::vector<Paint>& paints, unsigned firstUnit);

} // namespace render
} // namespace osgVolumizer
