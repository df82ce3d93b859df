#pragma once

#include <vtkDataReader.h>

namespace osgVolumizer {
namespace vtk {

/// Has a reader of legacy files read every array; else it reads the first of each kind.
inline void readAllArrays(vtkDataReader& reader)
{
    reader.ReadAllScalarsOn();
    reader.ReadAllVectorsOn();
    reader.ReadAllNormalsOn();
    reader.ReadAllTensorsOn();
    reader.ReadAllColorScalarsOn();
    reader.ReadAllTCoordsOn();
    reader.ReadAllFieldsOn();
}

} // namespace vtk
} // namespace osgVolumizer
