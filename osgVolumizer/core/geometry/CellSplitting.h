#pragma once

#include "../Export.h"
#include "Solids.h"

#include <vector>

namespace osgVolumizer {
namespace core {

/// Appends the tetrahedra of one cell, four indices each, oriented as the cell is.
///
/// All have the cell's lowest vertex as their apex, and every quadrilateral is cut by the diagonal
/// through its lowest vertex (Dompierre, Labbe, Vallet and Camarero, "How to subdivide pyramids,
/// prisms, and hexahedra into tetrahedra", 1999). So what happens to a face depends on the numbers
/// of its vertices alone, and the cells on both sides, of whatever kind, agree. A cell without
/// repeated vertices gives 1, 2, 3, or 5 to 6 tetrahedra; they fill it where it is convex.
/// \param corners cellSize(kind) vertices, in the order that CellKind states
OSGVOLUMIZER_CORE_EXPORT void splitCell(CellKind kind, const TetraSet::Index* corners,
                                        std::vector<TetraSet::Index>& indices);

} // namespace core
} // namespace osgVolumizer
