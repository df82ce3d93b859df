#include "GridFile.h"

#include "LegacyCells.h"

#include <osgVolumizer/core/RegularFile.h>

#include <osgDB/FileNameUtils>

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <exception>
#include <fstream>
#include <sstream>

namespace osgVolumizer {
namespace vtk {

namespace {

// Keeps the first error of a reader instead of printing it.
void keepError(vtkObject*, unsigned long, void* client, void* text)
{
    auto& error = *static_cast<std::string*>(client);
    if (!error.empty() || !text) return;
    error = static_cast<const char*>(text);
    // VTK's form is "ERROR: In FILE, line N\nCLASS (ADDRESS): WORDS\n\n".
    const std::size_t words = error.find("): ");
    if (words != std::string::npos) error.erase(0, words + 3);
    error.erase(error.find_last_not_of(" \n\r\t.") + 1);
    for (char& c : error)
        if (c == '\n') c = ' ';
}

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> runReader(Reader& reader, vtkCommand& keep,
                                               const std::string& path, std::string& error)
{
    reader.GetExecutive()->AddObserver(vtkCommand::ErrorEvent, &keep);
    reader.SetFileName(path.c_str());
    reader.Update();
    if (error.empty() && reader.GetErrorCode() != vtkErrorCode::NoError)
        error = vtkErrorCode::GetStringFromErrorCode(reader.GetErrorCode());
    return reader.GetOutput();
}

} // namespace

Result<vtkSmartPointer<vtkUnstructuredGrid>> readGrid(const std::string& path)
{
    const auto unreadable = [&path](const std::string& why) {
        return Status(ErrorCode::FILE_UNREADABLE, "File '" + path + "': " + why + ".");
    };
    if (const Status status = core::requireRegularFile(path); !status)
        return Status(status.code, "File " + status.text + ".");
    try {
        std::string error;
        vtkNew<vtkCallbackCommand> keep;
        keep->SetCallback(keepError);
        keep->SetClientData(&error);
        vtkSmartPointer<vtkUnstructuredGrid> grid;
        if (osgDB::getLowerCaseFileExtension(path) == "vtu") {
            vtkNew<vtkXMLUnstructuredGridReader> reader;
            reader->AddObserver(vtkCommand::ErrorEvent, keep);
            reader->SetParserErrorObserver(keep);
            grid = runReader(*reader, *keep, path, error);
        } else {
            vtkNew<vtkUnstructuredGridReader> reader;
            reader->AddObserver(vtkCommand::ErrorEvent, keep);
            reader->SetFileName(path.c_str());
            if (!reader->IsFileUnstructuredGrid())
                return unreadable("not a VTK file with DATASET UNSTRUCTURED_GRID");
            std::ifstream file(path, std::ios::binary);
            std::stringstream content;
            content << file.rdbuf();
            if (const Status cells = checkLegacyCells(content.str()); !cells)
                return unreadable(cells.text);
            grid = runReader(*reader, *keep, path, error);
        }
        if (!error.empty()) return unreadable(error);
        if (!grid || !grid->GetPoints() || grid->GetNumberOfPoints() == 0)
            return unreadable("there are no points");
        return grid;
    } catch (const std::exception& e) {
        return unreadable(e.what());
    }
}

} // namespace vtk
} // namespace osgVolumizer
