#pragma once

#include "VolumeInstance.h"

#include "../../core/ordering/DepthSchedule.h"

namespace osgVolumizer {
namespace render {

/// The faces that a volume's segments are drawn from: for each interval (far to near) and brick
/// (far to near) the faces that look at the eye of (geometry ∩ clip box ∩ interval ∩ beyond the
/// near plane). A convex body covers each pixel with exactly one of them, and behind opaque
/// geometry the depth test drops it before it is shaded.
std::shared_ptr<const VolumeMesh> slabMesh(const VolumeInstance& volume, const core::View& view,
                                           const std::vector<core::DepthInterval>& farToNear);

/// A triangle over the viewport for each of some intervals (depths from the reference depth, far to
/// near), in device coordinates, for a shader that finds the ray's part of the volume itself. See
/// ProgramFeatures::slotCount.
std::shared_ptr<const VolumeMesh> screenMesh(const BrickBatch& batch,
                                             const std::vector<core::DepthInterval>& farToNear);
/// The same for the whole of a volume of one brick.
std::shared_ptr<const VolumeMesh> screenMesh(const VolumeInstance& volume);

} // namespace render
} // namespace osgVolumizer
