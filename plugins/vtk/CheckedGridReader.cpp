#include "CheckedGridReader.h"

#include "FaceStream.h"

#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace osgVolumizer {
namespace vtk {

CheckedGridReader* CheckedGridReader::New()
{
    auto* reader = new CheckedGridReader;
    reader->InitializeObjectBase();
    return reader;
}

// VTK makes room before it reads.
int CheckedGridReader::ReadPiece(vtkXMLDataElement* piece)
{
    if (!Superclass::ReadPiece(piece)) return 0;
    constexpr double MOST_UNPACKED = 10000.0; // bytes that a compressor makes of one
    std::error_code failed;
    const auto bytes = static_cast<double>(std::filesystem::file_size(FileName, failed));
    const double most = bytes * (XMLParser->GetCompressor() ? MOST_UNPACKED : 1.0);
    const auto count =
        static_cast<double>(std::max(NumberOfPoints[Piece], GetNumberOfCellsInPiece(Piece)));
    if (!failed && count <= most) return 1;
    vtkErrorMacro("there is less in the file than the points and cells that it says it has");
    DataError = 1;
    return 0;
}

int CheckedGridReader::ReadPieceData()
{
    if (facesAreWhole()) return Superclass::ReadPieceData();
    vtkErrorMacro("the faces of polyhedra do not end where they should");
    DataError = 1;
    return 0;
}

// Null where there is none of that length.
vtkSmartPointer<vtkDataArray> CheckedGridReader::readCellArray(const char* name, vtkIdType count)
{
    vtkXMLDataElement* cells = CellElements[Piece];
    vtkXMLDataElement* element = cells ? FindDataArrayWithName(cells, name) : nullptr;
    if (!element) return nullptr;
    const auto created = vtkSmartPointer<vtkAbstractArray>::Take(CreateArray(element));
    vtkSmartPointer<vtkDataArray> array = vtkDataArray::SafeDownCast(created);
    if (!array || array->GetNumberOfComponents() != 1) return nullptr;
    array->SetNumberOfTuples(count);
    return ReadArrayValues(element, 0, array, 0, count) ? array : nullptr;
}

// The last offset is the length of the array; VTK reports arrays that are missing or shorter.
bool CheckedGridReader::facesAreWhole()
{
    const vtkIdType cells = GetNumberOfCellsInPiece(Piece);
    if (cells < 1 || !CellElements[Piece] ||
        !FindDataArrayWithName(CellElements[Piece], "faceoffsets"))
        return true;
    const vtkSmartPointer<vtkDataArray> offsets = readCellArray("faceoffsets", cells);
    if (!offsets) return false;
    std::int64_t polyhedra = 0, length = 0;
    for (vtkIdType c = 0; c < cells; ++c) {
        const auto offset = static_cast<std::int64_t>(offsets->GetComponent(c, 0));
        if (offset < 0) continue;
        ++polyhedra;
        length = offset;
    }
    if (length <= 0) return true;
    const vtkSmartPointer<vtkDataArray> faces = readCellArray("faces", length);
    if (!faces) return false;
    vtkIdType at = 0;
    const auto next = [&](std::int64_t& value) {
        if (at >= length) return false;
        value = static_cast<std::int64_t>(faces->GetComponent(at++, 0));
        return true;
    };
    for (std::int64_t p = 0; p < polyhedra; ++p)
        if (!skipFaces(next)) return false;
    return at == length;
}

} // namespace vtk
} // namespace osgVolumizer
