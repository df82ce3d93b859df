#pragma once

#include <osgVolumizer/core/Status.h>

class vtkUnstructuredGrid;

namespace osgVolumizer {
namespace vtk {

/// Whether the arrays of a grid are as long as VTK takes them to be, when it makes cells of them:
/// where the points of each cell begin, its degrees, the weights of points. INDEX_OUT_OF_RANGE,
/// SIZE_MISMATCH. The points themselves are not looked at.
Status checkGrid(vtkUnstructuredGrid& grid);

} // namespace vtk
} // namespace osgVolumizer
