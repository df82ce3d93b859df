#include "FormatPlugin.h"

#include "PluginFile.h"
#include "VolumeContents.h"

#include <osgDB/FileNameUtils>

#include <exception>

namespace osgVolumizer {
namespace io {

namespace {

std::string messageOf(const Status& status)
{
    return std::string(errorName(status.code)) + ": " + status.text;
}

} // namespace

VolumeContents::~VolumeContents() = default;

FormatPlugin::FormatPlugin(const char* plugin, const char* description)
{
    supportsExtension(plugin, description);
}

osgDB::ReaderWriter::ReadResult FormatPlugin::readObject(const std::string& name,
                                                         const Options* options) const
{
    if (!acceptsExtension(osgDB::getLowerCaseFileExtension(name)))
        return ReadResult::FILE_NOT_HANDLED;
    VolumeRequest request;
    request.path = osgDB::getNameLessExtension(name);
    try {
        Status status = decodeRequest(options, request);
        if (status.ok() && isListRequest(options)) {
            const Result<std::vector<VolumeEntry>> entries = list(request);
            if (!entries.ok()) return ReadResult(messageOf(entries.status));
            osg::ref_ptr<VolumeContents> contents = new VolumeContents;
            contents->entries = *entries;
            return contents.get();
        }
        if (!status.ok()) return ReadResult(messageOf(status));
        const Result<Source> source = read(request);
        if (source.ok()) return source->get();
        return ReadResult(messageOf(source.status));
    } catch (const std::exception& e) {
        return ReadResult(
            messageOf({ErrorCode::FILE_UNREADABLE, request.path + " cannot be read: " + e.what()}));
    }
}

osgDB::ReaderWriter::WriteResult
FormatPlugin::writeObject(const osg::Object& object, const std::string& name, const Options*) const
{
    if (!acceptsExtension(osgDB::getLowerCaseFileExtension(name)))
        return WriteResult::FILE_NOT_HANDLED;
    const auto* source = dynamic_cast<const VoxelSource*>(&object);
    if (!source) return WriteResult::FILE_NOT_HANDLED;
    const std::string path = osgDB::getNameLessExtension(name);
    try {
        const Status status = write(*source, path);
        if (status.ok()) return WriteResult::FILE_SAVED;
        return WriteResult(messageOf(status));
    } catch (const std::exception& e) {
        return WriteResult(
            messageOf({ErrorCode::FILE_UNREADABLE, path + " cannot be written: " + e.what()}));
    }
}

Result<std::vector<VolumeEntry>> FormatPlugin::list(const VolumeRequest& request) const
{
    const Result<Source> source = read(request);
    if (!source.ok()) return source.status;
    VolumeEntry entry = entryOf(**source, "");
    entry.chosen = true;
    return std::vector<VolumeEntry>{entry};
}

Status FormatPlugin::write(const VoxelSource&, const std::string& path) const
{
    return {ErrorCode::NOT_SUPPORTED, path + " is of a format that is only read"};
}

} // namespace io
} // namespace osgVolumizer
