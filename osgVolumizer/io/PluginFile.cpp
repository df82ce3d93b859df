#include "PluginFile.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <string_view>

namespace osgVolumizer {
namespace io {

namespace {

constexpr PluginFormat HDF5{"osgvolumizer_hdf5", "HDF5", "libhdf5 (Debian: libhdf5-dev)"};

struct Ending
{
    std::string_view text;
    const PluginFormat* format;
};
constexpr Ending ENDINGS[] = {{".h5", &HDF5}, {".hdf5", &HDF5}, {".he5", &HDF5}, {".ims", &HDF5}};

osg::ref_ptr<osgDB::Options> pluginOptions(const VoxelOptions& options)
{
    osg::ref_ptr<osgDB::Options> data = new osgDB::Options;
    if (options.dataset) data->setPluginStringData("dataset", *options.dataset);
    if (options.channel) data->setPluginStringData("channel", std::to_string(*options.channel));
    return data;
}

// The code that a plugin's message begins with.
Status statusOf(const std::string& message, const std::string& path)
{
    for (int i = 1; i <= static_cast<int>(ErrorCode::NOT_SUPPORTED); ++i) {
        const auto code = static_cast<ErrorCode>(i);
        const std::string start = std::string(errorName(code)) + ": ";
        if (message.compare(0, start.size(), start) == 0)
            return {code, message.substr(start.size())};
    }
    return {ErrorCode::FILE_UNREADABLE,
            path + " cannot be read" + (message.empty() ? message : ": " + message)};
}

} // namespace

const PluginFormat* pluginFormatOf(const std::string& path)
{
    const std::string name = osgDB::convertToLowerCase(osgDB::getSimpleFileName(path));
    for (const Ending& ending : ENDINGS)
        if (name.size() > ending.text.size() &&
            name.compare(name.size() - ending.text.size(), ending.text.size(), ending.text) == 0)
            return ending.format;
    return nullptr;
}

Result<Source> readByPlugin(const PluginFormat& format, const std::string& path,
                            const VoxelOptions& options)
{
    osgDB::ReaderWriter* reader =
        osgDB::Registry::instance()->getReaderWriterForExtension(format.plugin);
    if (!reader)
        return Status(ErrorCode::NOT_SUPPORTED, path + " is " + format.name +
                                                    ", which this build cannot read: build with " +
                                                    format.needs);
    osgDB::ReaderWriter::ReadResult result =
        reader->readObject(path + "." + format.plugin, pluginOptions(options).get());
    const Source source = dynamic_cast<VoxelSource*>(result.getObject());
    if (source) return source;
    return statusOf(result.message(), path);
}

} // namespace io
} // namespace osgVolumizer
