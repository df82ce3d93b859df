#include "CellShape.h"

#include <vtkCellType.h>

#include <algorithm>
#include <iterator>

namespace osgVolumizer {
namespace vtk {

namespace {

struct Kind
{
    int type;
    CellShape shape;
    int points; ///< 0: any number, or as the degree says
};
constexpr Kind KINDS[] = {{VTK_TETRA, CellShape::TETRA, 4},
                          {VTK_VOXEL, CellShape::HEXA, 8},
                          {VTK_HEXAHEDRON, CellShape::HEXA, 8},
                          {VTK_WEDGE, CellShape::WEDGE, 6},
                          {VTK_PYRAMID, CellShape::PYRAMID, 5},
                          {VTK_PENTAGONAL_PRISM, CellShape::PRISM, 10},
                          {VTK_HEXAGONAL_PRISM, CellShape::PRISM, 12},
                          {VTK_QUADRATIC_TETRA, CellShape::TETRA, 10},
                          {VTK_QUADRATIC_HEXAHEDRON, CellShape::HEXA, 20},
                          {VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, CellShape::HEXA, 24},
                          {VTK_TRIQUADRATIC_HEXAHEDRON, CellShape::HEXA, 27},
                          {VTK_QUADRATIC_LINEAR_WEDGE, CellShape::WEDGE, 12},
                          {VTK_QUADRATIC_WEDGE, CellShape::WEDGE, 15},
                          {VTK_BIQUADRATIC_QUADRATIC_WEDGE, CellShape::WEDGE, 18},
                          {VTK_QUADRATIC_PYRAMID, CellShape::PYRAMID, 13},
                          {VTK_TRIQUADRATIC_PYRAMID, CellShape::PYRAMID, 19},
                          {VTK_CONVEX_POINT_SET, CellShape::CONVEX, 0},
                          {VTK_POLYHEDRON, CellShape::POLYHEDRON, 0},
                          {VTK_LAGRANGE_TETRAHEDRON, CellShape::TETRA, 0},
                          {VTK_LAGRANGE_HEXAHEDRON, CellShape::HEXA, 0},
                          {VTK_LAGRANGE_WEDGE, CellShape::WEDGE, 0},
                          {VTK_BEZIER_TETRAHEDRON, CellShape::TETRA, 0},
                          {VTK_BEZIER_HEXAHEDRON, CellShape::HEXA, 0},
                          {VTK_BEZIER_WEDGE, CellShape::WEDGE, 0}};

constexpr int FLAT_TYPES[] = {VTK_QUADRATIC_EDGE,         VTK_QUADRATIC_TRIANGLE,
                              VTK_QUADRATIC_QUAD,         VTK_QUADRATIC_POLYGON,
                              VTK_BIQUADRATIC_QUAD,       VTK_QUADRATIC_LINEAR_QUAD,
                              VTK_BIQUADRATIC_TRIANGLE,   VTK_CUBIC_LINE,
                              VTK_LAGRANGE_CURVE,         VTK_LAGRANGE_TRIANGLE,
                              VTK_LAGRANGE_QUADRILATERAL, VTK_BEZIER_CURVE,
                              VTK_BEZIER_TRIANGLE,        VTK_BEZIER_QUADRILATERAL};

const Kind* find(int type)
{
    const auto* kind = std::find_if(std::begin(KINDS), std::end(KINDS),
                                    [type](const Kind& k) { return k.type == type; });
    return kind == std::end(KINDS) ? nullptr : kind;
}

// Nodes of a cell of those degrees.
vtkIdType nodeCount(CellShape shape, const Degrees& d)
{
    switch (shape) {
    case CellShape::TETRA:
        return vtkIdType(d[0] + 1) * (d[0] + 2) * (d[0] + 3) / 6;
    case CellShape::WEDGE:
        return vtkIdType(d[0] + 1) * (d[0] + 2) / 2 * (d[2] + 1);
    default:
        return vtkIdType(d[0] + 1) * (d[1] + 1) * (d[2] + 1);
    }
}

} // namespace

CellShape shapeOf(int type)
{
    if (const Kind* kind = find(type)) return kind->shape;
    const bool flat =
        (type >= 0 && type <= VTK_QUAD) ||
        std::find(std::begin(FLAT_TYPES), std::end(FLAT_TYPES), type) != std::end(FLAT_TYPES);
    return flat ? CellShape::FLAT : CellShape::UNKNOWN;
}

bool isHigherOrder(int type)
{
    return type >= VTK_LAGRANGE_CURVE && type < VTK_NUMBER_OF_CELL_TYPES;
}

bool isBezier(int type)
{
    return type >= VTK_BEZIER_CURVE && type < VTK_NUMBER_OF_CELL_TYPES;
}

bool canHave(int type, vtkIdType points, const std::optional<Degrees>& degrees)
{
    constexpr int HIGHEST_DEGREE = 10; // that VTK interpolates with
    const Kind* kind = find(type);
    if (!kind) return true;
    if (kind->shape == CellShape::CONVEX) return points >= 4 && points <= 64;
    if (!isHigherOrder(type)) return kind->points ? points == kind->points : points >= 4;
    // Quadratic ones with a node in the middle of each triangle, and of the cell.
    const vtkIdType full = kind->shape == CellShape::TETRA   ? 15
                           : kind->shape == CellShape::WEDGE ? 21
                                                             : 0;
    if (degrees) {
        const Degrees& d = *degrees;
        for (const int degree : d)
            if (degree < 1 || degree > HIGHEST_DEGREE) return false;
        if (kind->shape != CellShape::HEXA && d[0] != d[1]) return false;
        if (kind->shape == CellShape::TETRA && d[0] != d[2]) return false;
        return points == nodeCount(kind->shape, d) || (points == full && d == Degrees{2, 2, 2});
    }
    for (int degree = 1; degree <= HIGHEST_DEGREE; ++degree)
        if (points == nodeCount(kind->shape, {degree, degree, degree})) return true;
    return points == full;
}

} // namespace vtk
} // namespace osgVolumizer
