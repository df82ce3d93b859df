#pragma once

#include <vtkType.h>

#include <array>
#include <optional>

namespace osgVolumizer {
namespace vtk {

/// Subdivisions along the three parametric axes of a cell: 1 is linear, 2 quadratic.
using Degrees = std::array<int, 3>;

/// What VTK's kinds of cells look like.
enum class CellShape
{
    UNKNOWN,   ///< which VTK has no functions for
    FLAT,      ///< points, lines and faces
    TETRA,     ///< these four with nodes at equal steps
    HEXA,      ///< also voxels
    WEDGE,     ///<
    PYRAMID,   ///<
    PRISM,     ///< over pentagons and hexagons
    CONVEX,    ///< the hull of its points, of which there are at most 64
    POLYHEDRON ///< that says what its faces are
};

/// Of one of VTK's types.
CellShape shapeOf(int type);
/// Kinds of Lagrange and Bezier, which have as many nodes as their degree asks for.
bool isHigherOrder(int type);
/// Those whose inner nodes are control points, which their curves do not go through.
bool isBezier(int type);

/// Whether a cell of that type can have so many points. \param degrees that the grid states for it
bool canHave(int type, vtkIdType points, const std::optional<Degrees>& degrees);

} // namespace vtk
} // namespace osgVolumizer
