#pragma once

#include "FileHead.h"

#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

namespace osgVolumizer {
namespace vtkimage {

/// Reads an image (vtkImageData) or a rectilinear grid by VTK's own readers. \param array the only
/// one to read, but for the marks of what is hidden; null: all. \param step of time
/// FILE_UNREADABLE, with VTK's words where it has any; texts begin with the path.
Result<vtkSmartPointer<vtkDataSet>> readDataSet(const std::string& path, const FileHead& head,
                                                const ArrayInfo* array, int step);

} // namespace vtkimage
} // namespace osgVolumizer
