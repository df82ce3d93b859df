#include "GridCells.h"

#include "CheckGrid.h"

#include <osgVolumizer/core/geometry/CellSplitting.h>

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace vtk {

namespace {

// Marks of points or cells, a number each; null where there are none.
vtkUnsignedCharArray* marksOf(vtkDataSetAttributes& data, vtkIdType count)
{
    auto* marks =
        vtkUnsignedCharArray::SafeDownCast(data.GetArray(vtkDataSetAttributes::GhostArrayName()));
    const bool whole =
        marks && marks->GetNumberOfComponents() == 1 && marks->GetNumberOfTuples() >= count;
    return whole ? marks : nullptr;
}

bool hasLattice(CellShape shape)
{
    return shape == CellShape::TETRA || shape == CellShape::HEXA || shape == CellShape::WEDGE ||
           shape == CellShape::PYRAMID;
}

std::string named(vtkIdType cell)
{
    return "cell " + std::to_string(cell);
}

} // namespace

GridCells::GridCells(vtkUnstructuredGrid& grid, const GridValues& values, GridVertices& vertices)
    : _grid(grid), _values(values), _vertices(vertices)
{
    _pointMarks = marksOf(*grid.GetPointData(), grid.GetNumberOfPoints());
    _cellMarks = marksOf(*grid.GetCellData(), grid.GetNumberOfCells());
}

Status GridCells::cut()
{
    if (Status status = checkGrid(_grid); !status) return status;
    constexpr std::size_t MOST = std::numeric_limits<std::int32_t>::max(); // of either
    Cell cell;
    for (cell.number = 0; cell.number < _grid.GetNumberOfCells(); ++cell.number) {
        if (Status status = read(cell); !status) return status;
        if (Status status = append(cell); !status) return status;
        if (_indices.size() / 4 > MOST || _vertices.size() > MOST)
            return {ErrorCode::TOO_LARGE, "there are more than 2^31 tetrahedra or vertices"};
    }
    return {};
}

std::optional<Degrees> GridCells::degreesOf(vtkIdType cell) const
{
    vtkDataArray* array = _grid.GetCellData()->GetHigherOrderDegrees();
    if (!array) return {};
    Degrees degrees{};
    for (int axis = 0; axis < 3; ++axis) {
        const double d = array->GetComponent(cell, axis);
        degrees[static_cast<std::size_t>(axis)] = d >= 0.0 && d < 100.0 ? static_cast<int>(d) : 0;
    }
    return degrees;
}

Status GridCells::read(Cell& cell) const
{
    cell.type = _grid.GetCellType(cell.number);
    cell.shape = shapeOf(cell.type);
    cell.degrees.reset();
    if (isHigherOrder(cell.type)) cell.degrees = degreesOf(cell.number);
    cell.points.clear();
    if (cell.shape == CellShape::FLAT || cell.shape == CellShape::UNKNOWN) return {};
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    _grid.GetCellPoints(cell.number, count, corners);
    if (!canHave(cell.type, count, cell.degrees))
        return {ErrorCode::SIZE_MISMATCH,
                named(cell.number) + " has " + std::to_string(count) + " points", cell.number};
    for (vtkIdType i = 0; i < count; ++i) {
        if (corners[i] < 0 || corners[i] >= _grid.GetNumberOfPoints())
            return {ErrorCode::INDEX_OUT_OF_RANGE,
                    named(cell.number) + " refers to point " + std::to_string(corners[i]) + " of " +
                        std::to_string(_grid.GetNumberOfPoints()),
                    cell.number};
        cell.points.push_back(static_cast<Index>(corners[i]));
    }
    return {};
}

bool GridCells::isHidden(const Cell& cell) const
{
    if (_cellMarks && (_cellMarks->GetValue(cell.number) & vtkDataSetAttributes::HIDDENCELL) != 0)
        return true;
    return _pointMarks && std::any_of(cell.points.begin(), cell.points.end(), [this](Index point) {
               return (_pointMarks->GetValue(point) & vtkDataSetAttributes::HIDDENPOINT) != 0;
           });
}

bool GridCells::isFinite(const Cell& cell) const
{
    if (_values.ofCells()) return std::isfinite(static_cast<float>(_values.scalar(cell.number)));
    return std::all_of(cell.points.begin(), cell.points.end(),
                       [this](Index point) { return _vertices.isFinite(point); });
}

Status GridCells::append(const Cell& cell)
{
    const auto leaveOut = [this](CellTally::Reason reason) {
        _leftOut.add(reason);
        return Status();
    };
    if (cell.shape == CellShape::FLAT) return leaveOut(CellTally::FACES);
    if (cell.shape == CellShape::UNKNOWN) return leaveOut(CellTally::UNKNOWN);
    if (isHidden(cell)) return leaveOut(CellTally::HIDDEN);
    if (!isFinite(cell)) return leaveOut(CellTally::NOT_FINITE);
    if (hasLattice(cell.shape) && !latticeOf(cell)) return leaveOut(CellTally::UNKNOWN);
    const std::size_t begin = _indices.size();
    if (Status status = split(cell); !status) return status;
    keepWhatHasVolume(begin);
    const std::size_t count = (_indices.size() - begin) / 4;
    if (_values.ofCells())
        _scalars.insert(_scalars.end(), count, static_cast<float>(_values.scalar(cell.number)));
    return {};
}

Status GridCells::split(const Cell& cell)
{
    switch (cell.shape) {
    case CellShape::PRISM:
        splitPolyhedron(facesOfPrism(cell.points), _vertices, _indices);
        return {};
    case CellShape::POLYHEDRON: {
        const Result<std::vector<Polygon>> faces = facesOfPolyhedron(_grid, cell.number);
        if (!faces.ok()) return faces.status;
        splitPolyhedron(*faces, _vertices, _indices);
        return {};
    }
    case CellShape::CONVEX:
        splitPolyhedron(facesOfHull(cell.points, _vertices), _vertices, _indices);
        return {};
    default:
        splitLattice(cell, *latticeOf(cell));
        return {};
    }
}

// Null where VTK has none. Expects a shape that has lattices.
const CellLattice* GridCells::latticeOf(const Cell& cell)
{
    const auto key =
        std::make_tuple(cell.type, cell.points.size(), cell.degrees.value_or(Degrees{}));
    auto found = _lattices.find(key);
    if (found == _lattices.end())
        found = _lattices.emplace(key, makeLattice(cell.shape, *_grid.GetCell(cell.number))).first;
    return found->second ? &*found->second : nullptr;
}

void GridCells::splitLattice(const Cell& cell, const CellLattice& lattice)
{
    if (isBezier(cell.type)) evaluateBezier(cell);
    std::vector<Index> nodes = cell.points;
    for (const CellLattice::Extra& extra : lattice.extras) {
        GridVertices::Terms terms;
        for (const auto& [node, weight] : extra.weights)
            terms.emplace_back(nodes[static_cast<std::size_t>(node)], weight);
        GridVertices::Face corners{};
        for (std::size_t i = 0; i < 4 && extra.corners[0] >= 0; ++i)
            corners[i] = nodes[static_cast<std::size_t>(extra.corners[i])];
        nodes.push_back(extra.corners[0] >= 0 ? _vertices.addWithin(corners, terms)
                                              : _vertices.add(terms));
    }
    for (const CellLattice::Part& part : lattice.parts) {
        Index corners[8];
        for (int i = 0; i < core::cellSize(part.kind); ++i)
            corners[i] = nodes[static_cast<std::size_t>(part.nodes[static_cast<std::size_t>(i)])];
        core::splitCell(part.kind, corners, _indices);
    }
}

// Once for every control point: on a face, a cell is what the control points of the face make it.
void GridCells::evaluateBezier(const Cell& cell)
{
    _evaluated.resize(static_cast<std::size_t>(_grid.GetNumberOfPoints()), false);
    vtkCell* shape = nullptr;
    std::vector<double> weights(cell.points.size());
    for (std::size_t i = 0; i < cell.points.size(); ++i) {
        if (_evaluated[cell.points[i]]) continue;
        if (!shape) shape = _grid.GetCell(cell.number);
        _evaluated[cell.points[i]] = true;
        shape->InterpolateFunctions(shape->GetParametricCoords() + 3 * i, weights.data());
        GridVertices::Terms terms;
        for (std::size_t k = 0; k < weights.size(); ++k)
            if (weights[k] != 0.0) terms.emplace_back(cell.points[k], weights[k]);
        _vertices.move(cell.points[i], terms);
    }
}

// Takes away the tetrahedra from there on that repeat a vertex, and all where none has a volume.
void GridCells::keepWhatHasVolume(std::size_t begin)
{
    std::size_t kept = begin;
    double volume = 0.0, size = 0.0;
    const bool none = begin == _indices.size();
    for (std::size_t t = begin; t < _indices.size(); t += 4) {
        Index v[4];
        std::copy_n(&_indices[t], 4, v);
        std::sort(v, v + 4);
        if (std::adjacent_find(v, v + 4) != v + 4) continue;
        std::copy_n(&_indices[t], 4, &_indices[kept]);
        kept += 4;
        const glm::dvec3 a = _vertices.position(v[0]), b = _vertices.position(v[1]) - a,
                         c = _vertices.position(v[2]) - a, d = _vertices.position(v[3]) - a;
        volume += std::abs(glm::dot(b, glm::cross(c, d)));
        size = std::max({size, glm::length(b), glm::length(c), glm::length(d)});
    }
    if (kept == begin && !none) _leftOut.add(CellTally::REPEATED);
    if (none || (kept > begin && !(volume > 1e-15 * size * size * size))) {
        _leftOut.add(CellTally::NO_VOLUME);
        kept = begin;
    }
    _indices.resize(kept);
}

} // namespace vtk
} // namespace osgVolumizer
