#pragma once

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace osgVolumizer {
namespace vtk {

/// VTK's reader of .vtu files, which walks over the faces of polyhedra as far as they say that they
/// reach: first checks that this is where their array ends, and that the file is long enough for
/// the points and cells that it says it has. Where not, it fails with an error.
class CheckedGridReader final : public vtkXMLUnstructuredGridReader
{
public:
    using Superclass = vtkXMLUnstructuredGridReader;
    static CheckedGridReader* New();

protected:
    int ReadPiece(vtkXMLDataElement* piece) override;
    int ReadPieceData() override;

private:
    vtkSmartPointer<vtkDataArray> readCellArray(const char* name, vtkIdType count);
    bool facesAreWhole();
};

} // namespace vtk
} // namespace osgVolumizer
