#pragma once

#include <cpl_error.h>

#include <mutex>
#include <optional>
#include <string>

namespace osgVolumizer {
namespace gdal {

/// While one lives, no other thread of this plugin calls GDAL, which takes one thread at a time for
/// a file; and GDAL prints no errors, and reads and writes no files beside those that it is given.
/// Sessions of a thread may nest.
class Session
{
public:
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Why the last call failed, as the end of a sentence: ": ZLib error 5".
    std::string reason() const;

private:
    static void CPL_STDCALL keep(CPLErr kind, CPLErrorNum number, const char* text);

    std::unique_lock<std::recursive_mutex> _lock;
    std::optional<std::string> _before; ///< the thread's option for files beside
    std::string _failure;
};

/// A name of a file, which may hold anything, without line ends and the like.
std::string oneLine(std::string text);

} // namespace gdal
} // namespace osgVolumizer
