#pragma once

#include "CellLattice.h"
#include "CellTally.h"
#include "GridVertices.h"
#include "Polyhedra.h"

#include <map>
#include <tuple>
#include <vector>

class vtkUnstructuredGrid;
class vtkUnsignedCharArray;

namespace osgVolumizer {
namespace vtk {

/// Cuts the cells of a grid into tetrahedra that share faces wherever the cells do.
class GridCells
{
public:
    using Index = GridVertices::Index;

    /// Keeps references.
    GridCells(vtkUnstructuredGrid& grid, const GridValues& values, GridVertices& vertices);

    /// All of them. INDEX_OUT_OF_RANGE and SIZE_MISMATCH with the cell, TOO_LARGE.
    Status cut();

    const CellTally& leftOut() const { return _leftOut; }
    std::vector<Index> takeIndices() { return std::move(_indices); }
    /// One per tetrahedron, where the values are of cells.
    std::vector<float> takeScalars() { return std::move(_scalars); }

private:
    /// One cell.
    struct Cell
    {
        vtkIdType number = 0;
        int type = 0;
        CellShape shape = CellShape::UNKNOWN;
        std::vector<Index> points;
        std::optional<Degrees> degrees; ///< that the grid states
    };
    std::optional<Degrees> degreesOf(vtkIdType cell) const;
    Status read(Cell& cell) const;
    bool isHidden(const Cell& cell) const;
    bool isFinite(const Cell& cell) const;
    Status append(const Cell& cell);
    Status split(const Cell& cell);
    const CellLattice* latticeOf(const Cell& cell);
    void splitLattice(const Cell& cell, const CellLattice& lattice);
    void evaluateBezier(const Cell& cell);
    void keepWhatHasVolume(std::size_t begin);

    vtkUnstructuredGrid& _grid;
    const GridValues& _values;
    GridVertices& _vertices;
    vtkUnsignedCharArray *_pointMarks = nullptr, *_cellMarks = nullptr;
    std::map<std::tuple<int, std::size_t, Degrees>, std::optional<CellLattice>> _lattices;
    std::vector<bool> _evaluated; ///< control points
    std::vector<Index> _indices;
    std::vector<float> _scalars;
    CellTally _leftOut;
};

} // namespace vtk
} // namespace osgVolumizer
