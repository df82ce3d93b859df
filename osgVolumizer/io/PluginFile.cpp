#include "PluginFile.h"

#include "VolumeContents.h"

#include "../core/Text.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <limits>

namespace osgVolumizer {
namespace io {

namespace {

constexpr PluginFormat HDF5{"osgvolumizer_hdf5", "HDF5", "libhdf5 (Debian: libhdf5-dev)"};
constexpr PluginFormat DICOM{"osgvolumizer_itk", "DICOM", "ITK (Debian: libinsighttoolkit5-dev)"};
constexpr PluginFormat MEDICAL{"osgvolumizer_itk", "of a medical format",
                               "ITK (Debian: libinsighttoolkit5-dev)"};
constexpr PluginFormat VTK{"osgvolumizer_vtk", "of VTK", "VTK (Debian: libvtk9-dev)"};
constexpr PluginFormat OPENVDB{"osgvolumizer_openvdb", "OpenVDB",
                               "OpenVDB (Debian: libopenvdb-dev)"};
constexpr PluginFormat NETCDF{"osgvolumizer_gdal", "NetCDF", "GDAL (Debian: libgdal-dev)"};
constexpr PluginFormat ZARR{"osgvolumizer_gdal", "Zarr", "GDAL (Debian: libgdal-dev)"};

constexpr const char *DATASET = "dataset", *CHANNEL = "channel", *DIMENSIONS = "dimensions",
                     *FILES = "files", *LIST = "list";

osg::ref_ptr<osgDB::Options> encodeRequest(const VolumeRequest& request, bool list)
{
    osg::ref_ptr<osgDB::Options> data = new osgDB::Options;
    if (!request.dataset.empty()) data->setPluginStringData(DATASET, request.dataset);
    if (request.channel) data->setPluginStringData(CHANNEL, std::to_string(*request.channel));
    if (!request.dimensions.empty()) data->setPluginStringData(DIMENSIONS, request.dimensions);
    std::string files; // no path has a zero
    for (const std::string& file : request.files)
        files += (files.empty() ? "" : std::string(1, '\0')) + file;
    if (!files.empty()) data->setPluginStringData(FILES, files);
    if (list) data->setPluginStringData(LIST, "1");
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

osgDB::ReaderWriter* pluginOf(const std::vector<PluginFormat>& formats, std::string& name)
{
    for (const PluginFormat& format : formats) {
        name = format.plugin;
        if (auto* plugin = osgDB::Registry::instance()->getReaderWriterForExtension(name))
            return plugin;
    }
    return nullptr;
}

Status missing(const std::vector<PluginFormat>& formats, const std::string& path, const char* verb)
{
    return {ErrorCode::NOT_SUPPORTED, path + " is " + formats.front().name +
                                          ", which this build cannot " + verb + ": build with " +
                                          formats.front().needs};
}

osgDB::ReaderWriter::ReadResult ask(const std::vector<PluginFormat>& formats,
                                    const VolumeRequest& request, bool list, Status& status)
{
    std::string name;
    osgDB::ReaderWriter* reader = pluginOf(formats, name);
    if (!reader) {
        status = missing(formats, request.path, "read");
        return {};
    }
    osgDB::ReaderWriter::ReadResult result =
        reader->readObject(request.path + "." + name, encodeRequest(request, list).get());
    if (!result.getObject()) status = statusOf(result.message(), request.path);
    return result;
}

} // namespace

std::vector<PluginFormat> pluginFormatsOf(FileKind kind)
{
    switch (kind) {
    case FileKind::DICOM:
        return {DICOM};
    case FileKind::MEDICAL:
        return {MEDICAL};
    case FileKind::VTK:
        return {VTK};
    case FileKind::OPENVDB:
        return {OPENVDB};
    case FileKind::HDF5:
        return {HDF5, {NETCDF.plugin, HDF5.name, HDF5.needs}};
    case FileKind::NETCDF:
        return {NETCDF, {HDF5.plugin, NETCDF.name, NETCDF.needs}};
    case FileKind::ZARR:
        return {ZARR};
    default:
        return {};
    }
}

std::vector<PluginFormat> writersOf(const std::string& path)
{
    const std::string name = osgDB::convertToLowerCase(path);
    for (const std::string end : {".nrrd", ".nhdr", ".nii", ".nii.gz", ".mha", ".mhd"})
        if (name.size() > end.size() &&
            name.compare(name.size() - end.size(), end.size(), end) == 0)
            return {MEDICAL};
    return {};
}

Result<Source> readByPlugin(const std::vector<PluginFormat>& formats, const VolumeRequest& request)
{
    Status status;
    osgDB::ReaderWriter::ReadResult result = ask(formats, request, false, status);
    if (!status.ok()) return status;
    const Source source = dynamic_cast<VoxelSource*>(result.getObject());
    if (source) return source;
    return Status(ErrorCode::FILE_UNREADABLE, request.path + " has no voxels");
}

Result<std::vector<VolumeEntry>> listByPlugin(const std::vector<PluginFormat>& formats,
                                              const VolumeRequest& request)
{
    Status status;
    osgDB::ReaderWriter::ReadResult result = ask(formats, request, true, status);
    if (!status.ok()) return status;
    const osg::ref_ptr<VolumeContents> contents = dynamic_cast<VolumeContents*>(result.getObject());
    if (contents) return contents->entries;
    return Status(ErrorCode::FILE_UNREADABLE, request.path + " has no volumes");
}

Status writeByPlugin(const std::vector<PluginFormat>& formats, const VoxelSource& source,
                     const std::string& path)
{
    std::string name;
    osgDB::ReaderWriter* writer = pluginOf(formats, name);
    if (!writer) return missing(formats, path, "write");
    const osgDB::ReaderWriter::WriteResult result =
        writer->writeObject(source, path + "." + name, nullptr);
    return result.success() ? Status() : statusOf(result.message(), path);
}

Status decodeRequest(const osgDB::Options* options, VolumeRequest& request)
{
    if (!options) return {};
    request.dataset = options->getPluginStringData(DATASET);
    request.dimensions = options->getPluginStringData(DIMENSIONS);
    const std::string files = options->getPluginStringData(FILES);
    if (!files.empty())
        for (const std::string_view file : core::splitText(files, '\0'))
            request.files.emplace_back(file);
    const std::string channel = options->getPluginStringData(CHANNEL);
    std::int64_t number = 0;
    if (channel.empty()) return {};
    if (!core::parseInteger(channel, number) || number < 0 ||
        number > std::numeric_limits<int>::max())
        return {ErrorCode::VALUE_INVALID,
                "option channel is \"" + channel + "\", expected a number from 0"};
    request.channel = static_cast<int>(number);
    return {};
}

bool isListRequest(const osgDB::Options* options)
{
    return options && !options->getPluginStringData(LIST).empty();
}

VolumeEntry entryOf(const VoxelSource& source, const std::string& name)
{
    const VoxelSource::Description d = source.describe();
    VolumeEntry entry;
    entry.name = name;
    entry.size = {d.size.x, d.size.y, d.size.z};
    entry.type = d.type;
    entry.channels = d.components;
    entry.steps = source.stepCount();
    return entry;
}

} // namespace io
} // namespace osgVolumizer
