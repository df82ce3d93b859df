#include "GridFile.h"

#include "CheckedGridReader.h"
#include "ErrorKeeper.h"
#include "LegacyArrays.h"
#include "LegacyCells.h"

#include <osgVolumizer/core/RegularFile.h>

#include <osgDB/FileNameUtils>

#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkUnstructuredGridReader.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <sstream>

namespace osgVolumizer {
namespace vtk {

namespace {

Status unreadable(const std::string& path, const std::string& why)
{
    return {ErrorCode::FILE_UNREADABLE, "File '" + path + "': " + why + "."};
}

// Step `step` of those that a file may have.
Result<GridFile> readXml(const std::string& path, int step, ErrorKeeper& errors)
{
    vtkNew<CheckedGridReader> reader;
    errors.watch(*reader);
    errors.watch(*reader->GetExecutive());
    reader->SetReaderErrorObserver(errors.command());
    reader->SetParserErrorObserver(errors.command());
    reader->SetFileName(path.c_str());
    reader->UpdateInformation();
    GridFile file;
    file.steps = std::max(reader->GetNumberOfTimeSteps(), 1);
    if (step >= file.steps && errors.error().empty())
        return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                      "File '" + path + "': there is no time step " + std::to_string(step) +
                          ", but " + std::to_string(file.steps) + ", from 0 on.");
    reader->SetTimeStep(step);
    errors.run(*reader);
    file.grid = reader->GetOutput();
    return file;
}

Result<GridFile> readLegacy(const std::string& path, ErrorKeeper& errors)
{
    vtkNew<vtkUnstructuredGridReader> reader;
    errors.watch(*reader);
    errors.watch(*reader->GetExecutive());
    reader->SetFileName(path.c_str());
    if (!reader->IsFileUnstructuredGrid())
        return unreadable(path, "not a VTK file with DATASET UNSTRUCTURED_GRID");
    readAllArrays(*reader);
    std::ifstream stream(path, std::ios::binary);
    std::stringstream content;
    content << stream.rdbuf();
    if (const Status cells = checkLegacyCells(content.str()); !cells)
        return unreadable(path, cells.text);
    errors.run(*reader);
    GridFile file;
    file.grid = reader->GetOutput();
    return file;
}

} // namespace

Result<GridFile> readGrid(const std::string& path, int step)
{
    if (const Status status = core::requireRegularFile(path); !status)
        return Status(status.code, "File " + status.text + ".");
    try {
        ErrorKeeper errors;
        Result<GridFile> file = osgDB::getLowerCaseFileExtension(path) == "vtu"
                                    ? readXml(path, step, errors)
                                    : readLegacy(path, errors);
        if (!file) return file;
        if (!errors.error().empty()) return unreadable(path, errors.error());
        if (!file->grid || !file->grid->GetPoints() || file->grid->GetNumberOfPoints() == 0)
            return unreadable(path, "there are no points");
        return file;
    } catch (const std::exception& e) {
        return unreadable(path, e.what());
    }
}

bool holdsVolume(const std::string& path)
{
    if (osgDB::getLowerCaseFileExtension(path) == "vtu" || !core::requireRegularFile(path))
        return false;
    ErrorKeeper errors;
    vtkNew<vtkUnstructuredGridReader> reader;
    errors.watch(*reader);
    reader->SetFileName(path.c_str());
    return reader->IsFileStructuredPoints() || reader->IsFileRectilinearGrid();
}

} // namespace vtk
} // namespace osgVolumizer
