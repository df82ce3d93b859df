#pragma once

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkErrorCode.h>
#include <vtkNew.h>

#include <string>

namespace osgVolumizer {
namespace vtk {

/// Keeps the first error of VTK's objects, which then print neither errors nor warnings.
class ErrorKeeper
{
public:
    ErrorKeeper()
    {
        _command->SetCallback(keep);
        _command->SetClientData(&_error);
    }
    ErrorKeeper(const ErrorKeeper&) = delete;
    ErrorKeeper& operator=(const ErrorKeeper&) = delete;

    void watch(vtkObject& object)
    {
        object.AddObserver(vtkCommand::ErrorEvent, _command);
        object.AddObserver(vtkCommand::WarningEvent, _command);
    }
    /// Updates a reader, which is watched, and so is its executive.
    template <class Reader>
    void run(Reader& reader)
    {
        reader.Update();
        if (_error.empty() && reader.GetErrorCode() != vtkErrorCode::NoError)
            _error = vtkErrorCode::GetStringFromErrorCode(reader.GetErrorCode());
    }
    vtkCommand* command() { return _command; }
    /// Empty where all went well; without a full stop.
    const std::string& error() const { return _error; }

private:
    static void keep(vtkObject*, unsigned long event, void* client, void* text)
    {
        auto& error = *static_cast<std::string*>(client);
        if (event != vtkCommand::ErrorEvent || !error.empty() || !text) return;
        error = static_cast<const char*>(text);
        // VTK's form is "ERROR: In FILE, line N\nCLASS (ADDRESS): WORDS\n\n".
        const std::size_t words = error.find("): ");
        if (words != std::string::npos) error.erase(0, words + 3);
        error.erase(error.find_last_not_of(" \n\r\t.") + 1);
        for (char& c : error)
            if (static_cast<unsigned char>(c) < 32) c = ' ';
    }

    vtkNew<vtkCallbackCommand> _command;
    std::string _error;
};

} // namespace vtk
} // namespace osgVolumizer
