#pragma once

#include "VolumeMesh.h"
#include "VolumePart.h"

#include "../../core/ordering/DepthSchedule.h"

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
    core::DepthInterval wholeDepth; ///< eye units
};

/// Volumes that are marched together: see shaders/fused.glsl. Immutable once made.
struct FusedVolumes
{
    std::vector<FusedMember> members; ///< far to near, as far as they have an order
    double referenceDepth = 0.0;      ///< eye units; depths along rays are counted from here
    glm::dvec3 centerEye{0.0};        ///< that windows are counted from

    std::vector<ProgramFeatures> features() const
    {
        std::vector<ProgramFeatures> result;
        for (const FusedMember& member : members)
            result.push_back(member.part->features);
        return result;
    }
};

} // namespace render
} // namespace osgVolumizer
