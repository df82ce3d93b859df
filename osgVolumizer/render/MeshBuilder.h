#pragma once

#include "VolumeInstance.h"

#include "../core/Status.h"

namespace osgVolumizer {
namespace render {

/// Part of the depth axis, eye units.
struct DepthInterval
{
    double nearDepth = 0.0, farDepth = 0.0;
};

/// The faces that a volume's segments are drawn from: for each interval (far to near) and brick (far to near)
/// the faces that look at the eye of (geometry ∩ clip box ∩ interval ∩ beyond the near plane). A
/// convex body covers each pixel with exactly one of them, and behind opaque geometry the depth test
/// drops it before it is shaded.
std::shared_ptr<const VolumeMesh> slabMesh(const VolumeInstance& volume, const core::View& view,
                                           const std::vector<DepthInterval>& farToNear);

/// The faces of sampling surfaces, brick by brick, far to near; `spacing` receives their distance.
Result<std::shared_ptr<const VolumeMesh>> sliceMesh(const VolumeInstance& volume,
                                                    const core::View& view, double& spacing,
                                                    glm::dvec3& surfaceNormal);

} // namespace render
} // namespace osgVolumizer
