#pragma once

#include "VolumeRequest.h"
#include "VoxelFiles.h"

#include <osgDB/ReaderWriter>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace io {

/// A plugin for formats that another library reads, as readVoxels() asks it (see PluginFile.h). It
/// is an osgDB::ReaderWriter for a pseudo-extension of its own name: "scan.h5" is read as object
/// "scan.h5.osgvolumizer_hdf5", with the request as plugin data. What goes back is a VoxelSource,
/// or a VolumeContents, or a message of the name of an ErrorCode, ": " and a sentence. Nothing is
/// thrown.
///
/// A subclass returns statuses whose text begins with the path. It may throw std::exception.
class OSGVOLUMIZER_EXPORT FormatPlugin : public osgDB::ReaderWriter
{
public:
    ReadResult readObject(const std::string& name, const Options* options) const override;
    WriteResult writeObject(const osg::Object& object, const std::string& name,
                            const Options* options) const override;

protected:
    /// `plugin` is the pseudo-extension.
    FormatPlugin(const char* plugin, const char* description);

    virtual Result<Source> read(const VolumeRequest& request) const = 0;
    /// The volumes of a file: by default one, of the file's name.
    virtual Result<std::vector<VolumeEntry>> list(const VolumeRequest& request) const;
    /// Writes all of a file, which exists only if it is whole; by default NOT_SUPPORTED. Of time
    /// steps the first.
    virtual Status write(const VoxelSource& source, const std::string& path) const;
};

} // namespace io
} // namespace osgVolumizer
