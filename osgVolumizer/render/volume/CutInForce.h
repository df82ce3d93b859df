#pragma once

#include "VolumeInstance.h"

namespace osgVolumizer {
namespace render {

/// The box in which the cut of an appearance is asked for, in the frame of cuts.
core::Box3d cutBox(const PreparedGeometry& prepared, const Voxels* voxels);
/// What the appearance's cut leaves of a geometry; null where it cuts nothing.
/// \param anyPlanes see VolumeCut::cutOf()
std::shared_ptr<const core::Cut> cutInForce(const VolumeAppearance& appearance,
                                            const PreparedGeometry& prepared,
                                            bool anyPlanes = true);

/// Half-spaces (frame) of a volume's cut; none where these are for the shader to find: where the
/// cut is soft, or the volume deformed.
std::vector<core::Plane> planesOfCut(const VolumeInstance& volume);

/// What is left for the shader. Sets the features.
/// \param withPlanes also those that planesOfCut() has
CutLook makeCutLook(const VolumeInstance& volume, const glm::dvec3& centerFrame,
                    ProgramFeatures& features, bool withPlanes = false);

} // namespace render
} // namespace osgVolumizer
