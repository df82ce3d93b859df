#pragma once

#include <osgVolumizer/core/Status.h>

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace osgVolumizer {
namespace vtk {

struct GridFile
{
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    int steps = 1; ///< of time
};

/// Reads an unstructured grid by VTK's own readers: legacy (.vtk) or XML (.vtu), where it has
/// several time steps the one of that number. FILE_NOT_FOUND, INDEX_OUT_OF_RANGE, and
/// FILE_UNREADABLE with VTK's words where it has any.
Result<GridFile> readGrid(const std::string& path, int step);

/// Whether a legacy file holds an image or a rectilinear grid, which readVolume() reads.
bool holdsVolume(const std::string& path);

} // namespace vtk
} // namespace osgVolumizer
