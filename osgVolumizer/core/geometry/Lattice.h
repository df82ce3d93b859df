#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Box.h"
#include "TetraSet.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osgVolumizer {
namespace core {

/// Control points about a box that bend it and all within: the trivariate Bernstein polynomials of
/// Sederberg and Parry, "Free-form deformation of solid geometric models", SIGGRAPH 1986. Each
/// point moves all of the inside of the box a little, smoothly. At rest the points are a regular
/// grid, and nothing moves, to the bit. All in one object frame.
struct OSGVOLUMIZER_CORE_EXPORT Lattice
{
    /// Bounds on points and on cells along an axis.
    static constexpr int FEWEST_POINTS = 2, MOST_POINTS = 16, MOST_CELLS = 64;

    Box3d box;
    glm::ivec3 points{3};            ///< along each axis
    std::vector<glm::dvec3> offsets; ///< of the control points from rest, x fastest; none: all 0

    std::size_t count() const;
    /// Where a control point is at rest. Expects a number below count().
    glm::dvec3 restPoint(std::size_t number) const;
    /// Refuses (VALUE_INVALID) a box without volume, numbers of points outside the bounds, and
    /// offsets that are not finite or lead beyond TetraSet::MAX_MAGNITUDE; SIZE_MISMATCH for
    /// another number of offsets than of points.
    Status validate() const;

    /// The bent box: `cells` hexahedra along each axis, cut into tetrahedra, whose vertices keep
    /// the voxel coordinates that they have at rest, (point - origin) / spacing. Refuses, besides
    /// what validate() does, numbers of cells below 1 or above MOST_CELLS, and (VALUE_INVALID, with
    /// the number of the tetrahedron) a lattice that folds over: one that turns a tetrahedron
    /// inside out, or flat.
    Result<TetraSet> tessellate(const glm::ivec3& cells, const glm::dvec3& origin,
                                const glm::dvec3& spacing) const;
};

} // namespace core
} // namespace osgVolumizer
