#pragma once

#include "VoxelFiles.h"
#include "VoxelOptions.h"

#include <string>

namespace osgVolumizer {
namespace io {

/// A format that a plugin of this library reads, which is built where another library is found.
///
/// Which extension is whose stands in a table of this library, and is not asked of osgDB: so no
/// plugin of another is loaded, or tried, for a file that is read here; and where the plugin is
/// missing, there is a sentence about it. The plugin is an osgDB::ReaderWriter for a
/// pseudo-extension of its own name. It reads "scan.h5" as object "scan.h5.osgvolumizer_hdf5", with
/// the loader's options dataset and channel, where they are said, as plugin string data. What it
/// returns is a VoxelSource, or a message of the name of an ErrorCode, ": " and a sentence.
struct PluginFormat
{
    const char* plugin; ///< "osgvolumizer_hdf5", of the library osgdb_osgvolumizer_hdf5
    const char* name;   ///< "HDF5"
    const char* needs;  ///< completes "build with "
};

/// By the end of a name, whatever its case; null for all that is not left to a plugin.
OSGVOLUMIZER_EXPORT const PluginFormat* pluginFormatOf(const std::string& path);
/// NOT_SUPPORTED where there is no such plugin. Thread safe.
OSGVOLUMIZER_EXPORT Result<Source> readByPlugin(const PluginFormat& format, const std::string& path,
                                                const VoxelOptions& options);

} // namespace io
} // namespace osgVolumizer
