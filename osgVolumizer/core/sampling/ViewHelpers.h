#pragma once

#include "../Export.h"
#include "../Status.h"
#include "View.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace core {

/// A voxel axis: 0, 1 or 2, and whether the view goes up (+1) or down (-1) along it.
struct ViewAxis
{
    int axis = 2;
    int sign = 1;
};

/// Depths of the planes that bound the view volume, in eye units; `farDepth` may be infinite.
struct NearFar
{
    double nearDepth = 0.0;
    double farDepth = 0.0;
};

/// The affine inverse of `toEye`; SINGULAR_MATRIX where there is none, or where the last row is not
/// (0, 0, 0, 1) up to a few roundings (1e-14; its first three entries relative to their columns).
/// Scale is no reason: the volume of the parallelepiped of the axes is compared with the product of
/// their lengths (1e-12), so 1e-6 or 1e6 times the unit matrix is regular, and so is any scale per
/// axis. NaN and infinite values are singular.
OSGVOLUMIZER_CORE_EXPORT Result<glm::dmat4> fromEye(const View& view);

/// Centre of projection in the position frame, homogeneous: w = 1, or w = 0 for a parallel
/// projection, where xyz is then the unit direction towards the eye. Off-axis and mirrored views
/// are ordinary cases. SINGULAR_MATRIX where either matrix is singular.
OSGVOLUMIZER_CORE_EXPORT Result<glm::dvec4> eyePosition(const View& view);

/// Unit direction of the ray of sight through `position`, in the position frame; the direction in
/// which the view looks (the eye frame's -z) where `position` is the eye itself.
OSGVOLUMIZER_CORE_EXPORT Result<glm::dvec3> viewDirectionAt(const View& view,
                                                            const glm::dvec3& position);

/// The voxel axis that is closest to the ray of sight through `position`.
/// \param voxelSize position units per voxel and axis, > 0
OSGVOLUMIZER_CORE_EXPORT Result<ViewAxis> closestAxis(const View& view, const glm::dvec3& position,
                                                      const glm::dvec3& voxelSize);

/// Near and far depth of the projection, perspective, orthographic or off-axis, from the planes
/// z = -w and z = w. SINGULAR_MATRIX where the projection has no such planes.
OSGVOLUMIZER_CORE_EXPORT Result<NearFar> nearFar(const glm::dmat4& projection);

} // namespace core
} // namespace osgVolumizer
