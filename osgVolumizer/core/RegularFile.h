#pragma once

#include "Export.h"
#include "Status.h"

#include <string>

namespace osgVolumizer {
namespace core {

/// To be called before a file is opened for reading: FILE_NOT_FOUND where there is none,
/// FILE_UNREADABLE where it is, itself or through links, anything but a regular file. A pipe would
/// be waited for, and a device read for ever.
OSGVOLUMIZER_CORE_EXPORT Status requireRegularFile(const std::string& path);
/// The same before one is opened for writing, where there may be none yet.
OSGVOLUMIZER_CORE_EXPORT Status requireRegularTarget(const std::string& path);

} // namespace core
} // namespace osgVolumizer
