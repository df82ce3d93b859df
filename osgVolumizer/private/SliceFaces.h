#pragma once

#include "SliceShape.h"

#include "../core/geometry/BoxIndex.h"
#include "../core/geometry/TetraSet.h"
#include "../core/sampling/Sample.h"

#include <memory>

namespace osgVolumizer {

class VolumeSlice;
class Voxels;

namespace slices {

/// A slice within voxels: convex polygons, as yet across all bricks. Immutable once made.
struct SliceFaces
{
    glm::dvec3 center{0.0}; ///< object frame; positions are counted from here
    /// Records: voxel coordinates, position, and as four user values, the same for all of a face,
    /// how many voxels a unit of length (object frame) along the normal is, and how far along the
    /// normal the face is from where positions are counted (where it is drawn where it is in the
    /// volume).
    core::PolygonSet polygons;
    core::BoxIndex boxes;   ///< of each polygon in the voxel frame, a little larger
    core::Box3d bounds;     ///< of the positions, object frame
    bool ownPlaces = false; ///< it is drawn elsewhere than where it is taken to be

    static constexpr int ACROSS = 6, DISTANCE = 9; ///< offsets of the user values
};

/// \param region tetrahedra (object frame) that planes and polygons are cut out of; null: all
/// voxels TOO_LARGE where there is no memory for them; empty faces where nothing meets.
Result<std::shared_ptr<const SliceFaces>>
makeSliceFaces(const SliceShape& shape, const Voxels& voxels, const core::TetraSet* region);

/// What the library's own parts may ask of a slice. Thread safe.
struct SliceAccess
{
    /// Kept while neither slice, region nor voxels change. Null, reported, where they cannot be
    /// made.
    static std::shared_ptr<const SliceFaces> faces(const VolumeSlice& slice, const Voxels& voxels);
};

} // namespace slices
} // namespace osgVolumizer
