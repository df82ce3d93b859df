#pragma once

#include "GridVertices.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osgVolumizer {
namespace vtk {

/// Corners in a ring, in either direction.
using Polygon = std::vector<GridVertices::Index>;

/// Appends the tetrahedra of a cell by its faces, each of which is fanned out from its lowest
/// corner, as core::splitCell() does, so that neighbours agree. They have the cell's lowest corner
/// as their apex; where that does not see all faces (cells that are not convex, or whose faces are
/// warped) a vertex that is added at the mean of all corners. They fill the cell where that does.
void splitPolyhedron(const std::vector<Polygon>& faces, GridVertices& vertices,
                     std::vector<GridVertices::Index>& indices);

/// Of a polygon's points, and as many above them.
std::vector<Polygon> facesOfPrism(const std::vector<GridVertices::Index>& points);

/// As the grid states them. INDEX_OUT_OF_RANGE.
Result<std::vector<Polygon>> facesOfPolyhedron(vtkUnstructuredGrid& grid, vtkIdType cell);

/// The faces of the convex hull of points in space, where they are corners of it; those in one
/// plane, to a millionth of the hull's size, are one face.
std::vector<Polygon> facesOfHull(const std::vector<GridVertices::Index>& points,
                                 const GridVertices& vertices);

} // namespace vtk
} // namespace osgVolumizer
