#include "DataSetFile.h"

#include "../vtk/ErrorKeeper.h"
#include "../vtk/LegacyArrays.h"

#include <vtkDataArraySelection.h>
#include <vtkDataCompressor.h>
#include <vtkDataSetAttributes.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkObjectFactory.h>
#include <vtkRectilinearGrid.h>
#include <vtkRectilinearGridReader.h>
#include <vtkStructuredPoints.h>
#include <vtkStructuredPointsReader.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLRectilinearGridReader.h>

namespace osgVolumizer {
namespace vtkimage {

namespace {

using DataSet = vtkSmartPointer<vtkDataSet>;

void select(vtkDataArraySelection& selection, const ArrayInfo* array)
{
    if (!array) return;
    selection.DisableAllArrays();
    selection.EnableArray(vtkDataSetAttributes::GhostArrayName());
    selection.EnableArray(array->name.c_str());
}

/// Watches what unpacks the data, whose errors the readers take for the end of them.
class WatchedParser : public vtkXMLDataParser
{
public:
    static WatchedParser* New() { VTK_STANDARD_NEW_BODY(WatchedParser); }
    void SetCompressor(vtkDataCompressor* compressor) override
    {
        if (compressor) errors->watch(*compressor);
        vtkXMLDataParser::SetCompressor(compressor);
    }
    vtk::ErrorKeeper* errors = nullptr;
};

template <class Reader>
class WatchedReader : public Reader
{
public:
    static WatchedReader* New() { VTK_STANDARD_NEW_BODY(WatchedReader); }
    vtk::ErrorKeeper* errors = nullptr;

protected:
    void CreateXMLParser() override
    {
        if (this->XMLParser) this->DestroyXMLParser();
        WatchedParser* parser = WatchedParser::New();
        parser->errors = errors;
        errors->watch(*parser);
        this->XMLParser = parser;
    }
};

template <class Reader>
DataSet readXml(const std::string& path, const ArrayInfo* array, int step, vtk::ErrorKeeper& errors)
{
    vtkNew<WatchedReader<Reader>> reader;
    reader->errors = &errors;
    errors.watch(*reader);
    errors.watch(*reader->GetExecutive());
    reader->SetReaderErrorObserver(errors.command());
    reader->SetFileName(path.c_str());
    reader->UpdateInformation();
    select(*reader->GetPointDataArraySelection(), array);
    select(*reader->GetCellDataArraySelection(), array);
    reader->SetTimeStep(step);
    errors.run(*reader);
    return reader->GetOutputAsDataSet();
}

template <class Reader>
DataSet readLegacy(const std::string& path, vtk::ErrorKeeper& errors)
{
    vtkNew<Reader> reader;
    errors.watch(*reader);
    errors.watch(*reader->GetExecutive());
    reader->SetFileName(path.c_str());
    vtk::readAllArrays(*reader);
    errors.run(*reader);
    return reader->GetOutput();
}

DataSet readAny(const std::string& path, const FileHead& head, const ArrayInfo* array, int step,
                vtk::ErrorKeeper& errors)
{
    const bool parallel = !head.pieces.empty();
    if (!head.xml)
        return head.rectilinear ? readLegacy<vtkRectilinearGridReader>(path, errors)
                                : readLegacy<vtkStructuredPointsReader>(path, errors);
    if (head.rectilinear)
        return parallel ? readXml<vtkXMLPRectilinearGridReader>(path, array, step, errors)
                        : readXml<vtkXMLRectilinearGridReader>(path, array, step, errors);
    return parallel ? readXml<vtkXMLPImageDataReader>(path, array, step, errors)
                    : readXml<vtkXMLImageDataReader>(path, array, step, errors);
}

// VTK 9.1 takes no spacing and origin of files with time steps, nor directions of parallel ones.
void placeImage(vtkDataSet& set, const FileHead& head)
{
    auto* image = vtkImageData::SafeDownCast(&set);
    if (!image || !head.xml) return;
    image->SetSpacing(head.spacing.data());
    image->SetOrigin(head.origin.data());
    image->SetDirectionMatrix(head.direction.data());
}

} // namespace

Result<DataSet> readDataSet(const std::string& path, const FileHead& head, const ArrayInfo* array,
                            int step)
{
    // The readers of parallel files print what is wrong with a piece, and leave it empty.
    FileHead one = head;
    one.pieces.clear();
    for (const std::string& piece : head.pieces)
        if (const auto part = readDataSet(piece, one, array, step); !part.ok()) return part.status;
    vtk::ErrorKeeper errors;
    const DataSet set = readAny(path, head, array, step, errors);
    if (errors.error().empty() && set && set->GetNumberOfPoints() > 0) {
        placeImage(*set, head);
        return set;
    }
    return Status(ErrorCode::FILE_UNREADABLE,
                  path + ": " + (errors.error().empty() ? "there are no points" : errors.error()));
}

} // namespace vtkimage
} // namespace osgVolumizer
