#pragma once

#include "../../core/geometry/ConvexRegion.h"
#include "../../core/geometry/TetraSet.h"

#include <glm/mat4x4.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace osgVolumizer {
class Voxels;

namespace render {

/// A tetra set in the frame that is sent to GL. Where voxel coordinates are one affine function of
/// position (always, without explicit ones) that frame is the voxel frame; else it is the object
/// frame moved to the centre of the bounds and scaled to their size, by a power of two, and voxel
/// coordinates stay a field of the vertices.
/// Either way the numbers are small, so floats keep the precision that doubles in the object frame
/// had.
struct PreparedGeometry
{
    core::TetraSet tetras;
    glm::dmat4 frameToObject{1.0};
    bool voxelFrame = true;
    bool scalars = false;       ///< fill the tetrahedra in place of voxels
    int fieldShader = 0;        ///< its number, where vertices have user values; else 0
    double unitsPerFrame = 1.0; ///< object units per frame unit, where that is one
    double meanEdge = 1.0;      ///< frame; of a tetrahedron of mean volume, regular
    core::Box3d bounds;         ///< of the tetrahedra, in the frame
    std::optional<core::ConvexRegion> region; ///< in the frame, where the tetrahedra are convex
    /// What of the region its axis-aligned half-spaces leave (and the voxels), and the half-spaces
    /// that cut this further; `bounds` and none where there is no region.
    core::Box3d regionBox;
    std::vector<core::Plane> obliquePlanes;
};

/// The tetra set of a geometry, seen with voxels or none (null), or with scalars in their place.
std::shared_ptr<const PreparedGeometry> prepareGeometry(const core::TetraSet& set,
                                                        const Voxels* voxels, bool scalars = false,
                                                        int fieldShader = 0);

} // namespace render
} // namespace osgVolumizer
