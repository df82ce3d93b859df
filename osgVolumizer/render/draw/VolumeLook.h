#pragma once

#include "../context/LeafState.h"
#include "../textures/TableTextures.h"
#include "Paint.h"
#include "ProgramFeatures.h"
#include "SceneLights.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace osgVolumizer {
namespace render {

/// All that a volume's fragments are shaded with, besides brick and view.
struct VolumeLook
{
    ProgramFeatures features;
    TableTexture table;
    glm::vec2 valueToEntry{1.0f, 0.0f}; ///< scale and offset: texel -> entry of the table
    double texelToFraction = 1.0;       ///< scale of texels to fractions of the range
    float isoTexel = 0.0f;
    glm::vec4 material{0.0f};             ///< ambient, diffuse, specular, shininess
    glm::vec2 gradientDecode{1.0f, 0.0f}; ///< scale, offset: gradient texture -> texels per voxel
    std::vector<EyeLight> lights;         ///< of the stage; some may be off
    StateAbove above;
    glm::dmat3 frameToUnits{1.0};   ///< frame vector -> opacity units
    glm::dvec3 center{0.0};         ///< frame; the middle of the volume
    double referenceDepth = 0.0;    ///< eye units; depths of slabs are counted from here
    double step = 1.0;              ///< between samples or slices: depth, distance or frame units
    double voxelsPerSample = 1.0;   ///< along the view axis
    glm::dvec3 surfaceNormal{0.0};  ///< slices: frame units; along which `step` is counted
    bool inFrontOfLayer = false;    ///< slabs: which part of a segment split by surfaces
    glm::vec2 surfaceWeights{0.0f}; ///< captured surfaces: 1 if colour, alpha is weighted by alpha
    int rank = 0;                   ///< slabs: between which ranks of surfaces
    std::vector<glm::ivec4> scissors; ///< window rectangles to draw in; none: everywhere
    int maximumSteps = 1;
    glm::vec3 regionMin{0.0f}, regionMax{0.0f}; ///< slabs: box of the whole volume (frame)
    /// Slabs: part of a pixel, in the frame. Faces are this much larger than what they stand for:
    /// which pixels a segment covers is for the shader to say, whose answer does not depend on how
    /// GL rounds vertices or whom it gives the pixels on an edge.
    glm::dvec3 pixelMargin{0.0};
    std::vector<Paint> paints;
    std::vector<glm::vec4> planes; ///< the region's half-spaces (frame)
};

} // namespace render
} // namespace osgVolumizer
