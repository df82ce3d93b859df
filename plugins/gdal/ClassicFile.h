#pragma once

#include <osgVolumizer/core/Status.h>

#include <string>

namespace osgVolumizer {
namespace gdal {

/// Whether a NetCDF file of the classic formats (CDF-1, CDF-2, CDF-5) has all that its header says
/// it has: its library takes what is behind the end of a file for zeros. FILE_UNREADABLE, with a
/// text that begins with the path. Any other file is fine.
Status checkClassicFile(const std::string& path);

} // namespace gdal
} // namespace osgVolumizer
