#pragma once

#include "../context/LeafState.h"
#include "Paint.h"
#include "SceneLights.h"
#include "VolumeLook.h"

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

struct FusedVolumes;

/// What one leaf draws of a volume. Immutable once it is given to a leaf.
struct VolumePart
{
    std::shared_ptr<const VolumeLook> look;
    std::shared_ptr<const std::vector<EyeLight>>
        lights;                                       ///< of the stage, some perhaps off; or null
    std::shared_ptr<const std::vector<Paint>> paints; ///< null for none
    StateAbove above;
    ProgramFeatures features; ///< the look's, and what this part needs besides
    double rayDistance = 1.0; ///< pixels between rays: see CoarseImage
    double step = 1.0;        ///< between samples or slices: depth, distance or frame units
    /// Several volumes that are marched together, or null. `look` and `features` are then those of
    /// the march: table, voxels and paint are the members' own.
    std::shared_ptr<const FusedVolumes> fused;
    std::vector<glm::ivec4> scissors; ///< window rectangles to draw in; none: everywhere
    glm::ivec4 covered{0};            ///< window rectangle that holds all that is drawn
    glm::dvec3 surfaceNormal{0.0};    ///< slices: frame units; along which `step` is counted
    bool inFrontOfSplit = false;      ///< slabs: which part of a segment that surfaces split
    int rank = 0;                     ///< slabs: the segment behind this rank of surfaces
    glm::vec2 surfaceWeights{0.0f}; ///< captured surfaces: 1 if colour, alpha is weighted by alpha
};

} // namespace render
} // namespace osgVolumizer
