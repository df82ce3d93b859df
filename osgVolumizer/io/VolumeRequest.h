#pragma once

#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace io {

/// What a plugin of this library (see FormatPlugin.h) is asked to read.
struct VolumeRequest
{
    std::string path; ///< a file or folder that exists
    /// The files to take together, as the slices of a series; empty where it is `path` alone.
    std::vector<std::string> files;
    std::string dataset;        ///< which volume of several (see VolumeEntry); empty: not said
    std::optional<int> channel; ///< which component of several, from 0
    std::string dimensions;     ///< "x,y,z" or "x,y,z,time": names; empty: not said
};

} // namespace io
} // namespace osgVolumizer
