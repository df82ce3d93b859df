#pragma once

#include <osgVolumizer/core/Status.h>

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace osgVolumizer {
namespace vtk {

/// Reads an unstructured grid by VTK's own readers: legacy (.vtk) or XML (.vtu). FILE_NOT_FOUND,
/// and FILE_UNREADABLE with VTK's words where it has any.
Result<vtkSmartPointer<vtkUnstructuredGrid>> readGrid(const std::string& path);

} // namespace vtk
} // namespace osgVolumizer
