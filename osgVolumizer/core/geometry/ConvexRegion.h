#pragma once

#include "../Export.h"
#include "Box.h"
#include "ConvexPolytope.h"
#include "TetraSet.h"

#include <optional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A convex region as an intersection of half-spaces, in the position frame. Normals point inwards
/// and have length 1; no two planes are the same.
struct ConvexRegion
{
    std::vector<Plane> planes;
    Box3d bounds;

    bool contains(const glm::dvec3& p, double tolerance = 0.0) const
    {
        for (const Plane& plane : planes)
            if (!(plane.distance(p) >= -tolerance)) return false;
        return true;
    }
};

/// The union of the tetrahedra, if it is one convex polytope that they fill without gap or overlap;
/// else nothing. Expects a valid set. Proof: faces that two tetrahedra share from opposite sides
/// cancel; if every other face lies in a plane that has the whole set on one side, the boundary of
/// the set lies on its convex hull, so points inside the hull are all covered equally often, and
/// the volumes tell whether that is once. Lengths are compared to 1e-9 of the bounds' diagonal.
/// Tetrahedra without volume are ignored; coplanar faces are merged.
OSGVOLUMIZER_CORE_EXPORT std::optional<ConvexRegion> convexRegion(const TetraSet& tetraSet);

/// Clips a polytope by all planes of a region; the faces get the tags firstTag, firstTag + 1...
OSGVOLUMIZER_CORE_EXPORT void clipPolytope(ConvexPolytope& polytope, const ConvexRegion& region,
                                           int firstTag);

} // namespace core
} // namespace osgVolumizer
