#include "CheckGrid.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace osgVolumizer {
namespace vtk {

namespace {

// Whether every cell's points lie where the grid says that they begin.
Status checkOffsets(vtkUnstructuredGrid& grid)
{
    vtkCellArray* cells = grid.GetCells();
    const vtkIdType count = grid.GetNumberOfCells();
    if (!cells || cells->GetNumberOfCells() != count ||
        (count > 0 && grid.GetCellTypesArray()->GetNumberOfTuples() != count))
        return {ErrorCode::SIZE_MISMATCH, "the numbers of cells and of their types differ"};
    vtkDataArray& offsets = *cells->GetOffsetsArray();
    const vtkIdType size = cells->GetNumberOfConnectivityIds();
    double last = 0.0;
    for (vtkIdType c = 0; c <= count && count > 0; ++c) {
        const double offset = offsets.GetComponent(c, 0);
        if (!(offset >= last && offset <= static_cast<double>(size)))
            return {ErrorCode::INDEX_OUT_OF_RANGE,
                    "the points of cell " + std::to_string(c) + " begin out of order", c};
        last = offset;
    }
    return {};
}

} // namespace

Status checkGrid(vtkUnstructuredGrid& grid)
{
    vtkDataArray* degrees = grid.GetCellData()->GetHigherOrderDegrees();
    if (degrees && (degrees->GetNumberOfComponents() != 3 ||
                    degrees->GetNumberOfTuples() < grid.GetNumberOfCells()))
        return {ErrorCode::SIZE_MISMATCH, "the degrees of cells are not three for each"};
    vtkDataArray* weights = grid.GetPointData()->GetRationalWeights();
    if (weights && (weights->GetNumberOfComponents() != 1 ||
                    weights->GetNumberOfTuples() < grid.GetNumberOfPoints()))
        return {ErrorCode::SIZE_MISMATCH, "the rational weights are not one for each point"};
    return checkOffsets(grid);
}

} // namespace vtk
} // namespace osgVolumizer
