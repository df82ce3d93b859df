#pragma once

#include "../context/LeafState.h"
#include "../textures/TableTextures.h"
#include "../textures/TetraTextures.h"
#include "CutLook.h"
#include "ProgramFeatures.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace osgVolumizer {
namespace render {

/// How one appearance fills one geometry in one view. Immutable once made.
struct VolumeLook
{
    ProgramFeatures features;
    TableTexture table;
    glm::vec2 valueToEntry{1.0f, 0.0f}; ///< scale and offset: texel -> entry of the table
    double texelToFraction = 1.0;       ///< scale of texels to fractions of the range
    float isoTexel = 0.0f;
    FogAbove fog;                         ///< with the feature
    glm::vec4 material{0.0f};             ///< ambient, diffuse, specular, shininess
    glm::vec2 gradientDecode{1.0f, 0.0f}; ///< scale, offset: gradient texture -> texels per voxel
    glm::dmat3 frameToUnits{1.0};         ///< frame vector -> opacity units
    glm::dvec3 center{0.0};               ///< frame; the middle of the volume
    double referenceDepth = 0.0;          ///< eye units; depths of slabs are counted from here
    double step = 1.0;                    ///< eye units of depth between samples
    double voxelsPerSample = 1.0;         ///< along the view axis
    double stepsPerLength = 0.0;          ///< of the frame, where an error is kept; else 0
    double mostWeight = 0.0;              ///< of a step: see core::AdaptiveStep; where steps adapt
    int maximumSteps = 1;
    double opaqueEnough = 3e-5;                 ///< what is left of the light where rays end
    glm::vec3 regionMin{0.0f}, regionMax{0.0f}; ///< slabs: box of the whole volume (frame)
    /// Half-spaces (frame) that cut: clip planes, those of a VolumeCut, and slabs by those of the
    /// region.
    std::vector<glm::vec4> planes;
    CutLook cut;                                     ///< with the feature; its number always
    std::shared_ptr<const TetraTextures> tetrahedra; ///< with the feature
    /// Slabs: part of a pixel, in the frame. Faces are this much larger than what they stand for:
    /// which pixels a segment covers is for the shader to say, whose answer does not depend on how
    /// GL rounds vertices or whom it gives the pixels on an edge.
    glm::dvec3 pixelMargin{0.0};
};

} // namespace render
} // namespace osgVolumizer
