#pragma once

#include "FileKind.h"
#include "VolumeRequest.h"
#include "VoxelFiles.h"

#include <string>
#include <vector>

namespace osgVolumizer {
namespace io {

/// A format that a plugin of this library reads, which is built where another library is found.
///
/// Which kind of file is whose stands in a table of this library, and is not asked of osgDB: so no
/// plugin of another is loaded, or tried, for a file that is read here; and where the plugin is
/// missing, there is a sentence about it. See FormatPlugin.h for how a plugin is asked.
struct PluginFormat
{
    const char* plugin; ///< "osgvolumizer_hdf5", of the library osgdb_osgvolumizer_hdf5
    const char* name;   ///< "HDF5"
    const char* needs;  ///< completes "build with "
};

/// Those that read a kind of file, the best first; none for what is not left to plugins.
OSGVOLUMIZER_EXPORT std::vector<PluginFormat> pluginFormatsOf(FileKind kind);
/// The ones that write a file of such a name: NIfTI, NRRD, MetaImage, ...
OSGVOLUMIZER_EXPORT std::vector<PluginFormat> writersOf(const std::string& path);

/// By the first of them that there is; NOT_SUPPORTED where there is none. Expects one at least.
/// Thread safe.
OSGVOLUMIZER_EXPORT Result<Source> readByPlugin(const std::vector<PluginFormat>& formats,
                                                const VolumeRequest& request);
OSGVOLUMIZER_EXPORT Result<std::vector<VolumeEntry>>
listByPlugin(const std::vector<PluginFormat>& formats, const VolumeRequest& request);
OSGVOLUMIZER_EXPORT Status writeByPlugin(const std::vector<PluginFormat>& formats,
                                         const VoxelSource& source, const std::string& path);

/// What a plugin is asked, from its plugin data; the path is not there. Refuses (VALUE_INVALID)
/// what this library does not write.
OSGVOLUMIZER_EXPORT Status decodeRequest(const osgDB::Options* options, VolumeRequest& request);
/// Whether it is asked for VolumeContents, not for voxels.
OSGVOLUMIZER_EXPORT bool isListRequest(const osgDB::Options* options);

/// What is known of a source, under a name by which it is asked for.
OSGVOLUMIZER_EXPORT VolumeEntry entryOf(const VoxelSource& source, const std::string& name);

} // namespace io
} // namespace osgVolumizer
