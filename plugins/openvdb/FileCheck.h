#pragma once

#include <osgVolumizer/core/Status.h>

#include <string>

namespace osgVolumizer {
namespace vdb {

/// Whether a file can be what it says: all names and metadata, and all grids by their places, lie
/// within it. The library itself takes whatever memory a length asks for, and goes on at the end of
/// a file. FILE_UNREADABLE; what is within the grids is not looked at, nor are files older than
/// version 218 (2013). The text begins with the path.
Status checkFile(const std::string& path);

} // namespace vdb
} // namespace osgVolumizer
