#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Box.h"
#include "TetraSet.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osgVolumizer {
namespace core {

/// The number of tetrahedra that a box is cut into: 5, 24 (about its centre, symmetric), or one
/// that encloses it.
enum class BoxTessellation : int
{
    FIVE,
    TWENTY_FOUR,
    ENCLOSING
};

/// Kinds of indexed solids, with the vertices of one cell. Vertices of a pair of faces lie above
/// each other in the same order.
enum class CellKind : int
{
    TETRA,   ///< 4
    PYRAMID, ///< base 0 1 2 3 in a ring, apex 4
    PRISM,   ///< triangle 0 1 2, triangle 3 4 5 above it
    HEXA,    ///< ring 0 1 2 3, ring 4 5 6 7 above it
};

/// Runs of cells that share vertices.
enum class StripKind : int
{
    TETRA_FACE, ///< each vertex after the third makes a tetrahedron with the three before it
    TETRA_EDGE, ///< vertices in pairs; each pair after the first makes one with the pair before it
    HEXA,    ///< rings of 4; each ring after the first makes a hexahedron with the ring before it
    PYRAMID, ///< apex, then a quad strip of base vertices (left, right, left, right...)
    PRISM_FACE, ///< pairs (bottom, top); each after the second makes a prism with the two before it
    PRISM_BASE, ///< triangles; each after the first makes a prism with the triangle before it
    PRISM_EDGE, ///< pairs (bottom, top); prisms of pairs 0 1 2, 2 3 4...: neighbours share one edge
};

/// An indexed solid: cells over shared vertices.
struct OSGVOLUMIZER_CORE_EXPORT CellSet
{
    CellKind kind = CellKind::TETRA;
    VertexArray vertices;
    std::vector<TetraSet::Index> indices;

    /// Cuts every cell into tetrahedra around its lowest vertex, every quadrilateral by the
    /// diagonal through its lowest vertex, so neighbours agree (Dompierre, Labbe, Vallet and
    /// Camarero, "How to subdivide pyramids, prisms, and hexahedra into tetrahedra", 1999).
    /// Orientation follows that of the cell. INDEX_OUT_OF_RANGE, SIZE_MISMATCH and VALUE_INVALID
    /// with the offending index.
    Result<TetraSet> tessellate() const;
};

/// Vertices per cell: 4, 5, 6, 8.
OSGVOLUMIZER_CORE_EXPORT int cellSize(CellKind kind);

/// The cells of a strip. SIZE_MISMATCH where the indices do not end with a cell.
OSGVOLUMIZER_CORE_EXPORT Result<CellSet> makeStrip(StripKind kind, VertexArray vertices,
                                                   const std::vector<TetraSet::Index>& indices);

/// FIVE: one at every other corner, and the one that they leave. ENCLOSING: a corner at box.min
/// with legs three times as long as the box, the smallest tetrahedron around it: 4.5 times its
/// volume. Takes any box, also one without thickness; TetraSet::validate() tells of others.
OSGVOLUMIZER_CORE_EXPORT TetraSet tessellateBox(const Box3d& box, BoxTessellation how);

// Solids with curved faces are inscribed, so that their volumes converge from below, at second
// order in 1/slices. All refuse (VALUE_INVALID) radii and lengths that are not positive and finite,
// (TOO_LARGE) more than 2^24 tetrahedra, and fewer slices than they need.

struct OSGVOLUMIZER_CORE_EXPORT Cone
{
    glm::dvec3 base{0.0}, apex{0.0, 0.0, 1.0};
    double radius = 1.0;
    int slices = 32; ///< >= 3
    Result<TetraSet> tessellate() const;
};

struct OSGVOLUMIZER_CORE_EXPORT Cylinder
{
    glm::dvec3 bottom{0.0}, top{0.0, 0.0, 1.0};
    double radius = 1.0;
    int slices = 32; ///< >= 3
    int stacks = 1;  ///< >= 1, along the axis
    Result<TetraSet> tessellate() const;
};

struct OSGVOLUMIZER_CORE_EXPORT Sphere
{
    glm::dvec3 center{0.0};
    double radius = 1.0;
    int slices = 32; ///< >= 3, around the z axis
    int stacks = 32; ///< >= 2, from pole to pole
    Result<TetraSet> tessellate() const;
};

/// Icosahedron whose edges are divided into `frequency` parts, on the sphere.
struct OSGVOLUMIZER_CORE_EXPORT GeodesicSphere
{
    glm::dvec3 center{0.0};
    double radius = 1.0;
    int frequency = 8; ///< >= 1
    Result<TetraSet> tessellate() const;
};

/// A box without a sphere that lies inside it: hexahedra between sphere and box,
/// each face of the box divided `divisions` times. VALUE_INVALID where the sphere touches the box.
struct OSGVOLUMIZER_CORE_EXPORT BoxMinusSphere
{
    Box3d box;
    glm::dvec3 center{0.0};
    double radius = 1.0;
    int divisions = 16;
    Result<TetraSet> tessellate() const;
};

/// A box with a hole drilled through it along an axis.
struct OSGVOLUMIZER_CORE_EXPORT BoxMinusCylinder
{
    Box3d box;
    glm::dvec3 center{0.0}; ///< any point on the axis
    int axis = 2;
    double radius = 1.0;
    int divisions = 16; ///< of each of the four sides
    int stacks = 1;     ///< along the axis
    Result<TetraSet> tessellate() const;
};

} // namespace core
} // namespace osgVolumizer
