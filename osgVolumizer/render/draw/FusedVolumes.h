#pragma once

#include "VolumeMesh.h"
#include "VolumePart.h"

#include <glm/mat4x4.hpp>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// One of several volumes, or bricks of one, that are marched together.
struct FusedMember
{
    std::shared_ptr<const VolumePart> part;
    BrickBatch batch; ///< without triangles
    glm::dmat4 frameToEye{1.0};
};

/// Volumes that are marched together: see shaders/fused.glsl. Immutable once made.
struct FusedVolumes
{
    std::vector<FusedMember> members; ///< far to near, as far as they have an order
    double referenceDepth = 0.0;      ///< eye units; depths along rays are counted from here
    glm::dvec3 centerEye{0.0};        ///< that windows are counted from
};

/// What each member of a part that marches several has to do; empty for a volume by itself.
inline std::vector<ProgramFeatures> membersOf(const VolumePart& part)
{
    std::vector<ProgramFeatures> result;
    if (!part.fused) return result;
    for (const FusedMember& member : part.fused->members)
        result.push_back(member.part->features);
    return result;
}

} // namespace render
} // namespace osgVolumizer
