#pragma once

#include "CellShape.h"

#include <osgVolumizer/core/geometry/Solids.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

class vtkCell;

namespace osgVolumizer {
namespace vtk {

/// How the cells of one kind are cut into linear ones between their nodes: into eight for each
/// quadratic tetrahedron, wedge or hexahedron, ten for a pyramid, and so on with the degree. What
/// becomes of a face depends on its nodes alone, so that neighbours agree: a triangle is cut into
/// similar ones, a quadrilateral into as many as its degrees say. Where it has no node within
/// (kinds of 8 nodes to a face), one is added, by the cell's own functions, which on a face depend
/// on the face's nodes alone. Nodes in the middle of triangles are passed over.
struct CellLattice
{
    /// Nodes are VTK's, and then those that are added.
    struct Part
    {
        core::CellKind kind;
        std::array<int, 8> nodes;
    };
    struct Extra
    {
        std::vector<std::pair<int, double>> weights; ///< of nodes
        std::array<int, 4> corners;                  ///< of the face around it; -1: within the cell
    };

    std::vector<Part> parts;
    std::vector<Extra> extras;
};

/// The lattice of a tetrahedron, hexahedron, wedge or pyramid, by VTK's parametric coordinates of
/// its nodes; tetrahedra as of Bey ("Tetrahedral grid refinement", 1995). Nothing where these are
/// not what VTK 9 documents.
std::optional<CellLattice> makeLattice(CellShape shape, vtkCell& cell);

} // namespace vtk
} // namespace osgVolumizer
