#pragma once

#include "CellTally.h"

#include <osgVolumizer/core/Status.h>
#include <osgVolumizer/core/geometry/TetraSet.h>

#include <optional>
#include <string>
#include <vector>

class vtkUnstructuredGrid;

namespace osgVolumizer {
namespace vtk {

/// What a grid holds, as tetrahedra: colours of points as C4F, or scalars.
struct GridGeometry
{
    core::TetraSet tetras;
    std::vector<float> scalars;  ///< empty: colours; of vertices that no tetrahedron has: NaN
    bool perTetrahedron = false; ///< else one scalar per vertex
    std::string name;            ///< of the array
    std::string notice;          ///< of what is shown of it, to be told; often empty
    CellTally leftOut;
    double spacing = 1.0; ///< object units between samples that the cells call for
};

/// Takes linear, quadratic, Lagrange and Bezier tetrahedra, pyramids, wedges and hexahedra, prisms,
/// polyhedra and convex sets of points. Curved cells are cut between their nodes (CellLattice.h);
/// in each tetrahedron the scalar is linear, so that the picture is exact for what linear cells
/// hold on tetrahedra, and elsewhere of second order in the distance of nodes: for a quadratic cell
/// of size h, in h/2. Cells of other kinds, without a volume, hidden, or with a value that is not
/// finite, are left out, and counted.
/// \param arrayName, channel: see GridValues::of()
/// VALUE_INVALID where nothing is left, or there is no such array; INDEX_OUT_OF_RANGE and
/// SIZE_MISMATCH with the cell; TOO_LARGE. Messages do not name the file.
Result<GridGeometry> convertGrid(vtkUnstructuredGrid& grid, const std::string& arrayName,
                                 std::optional<int> channel = {});

} // namespace vtk
} // namespace osgVolumizer
