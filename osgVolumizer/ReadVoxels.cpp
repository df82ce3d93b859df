#include "ReadVoxels.h"

#include "VoxelSeries.h"
#include "io/FindVolume.h"
#include "io/PluginFile.h"
#include "io/PyramidSource.h"
#include "io/VoxelFiles.h"
#include "io/VoxelOptions.h"

#include <osg/Notify>
#include <osgDB/FileUtils>

#include <exception>

namespace osgVolumizer {

namespace {

io::VolumeRequest requestOf(const std::string& path, const io::VoxelOptions& said)
{
    io::VolumeRequest request;
    request.path = path;
    request.dataset = said.dataset.value_or("");
    request.channel = said.channel;
    request.dimensions = said.dimensions.value_or("");
    return request;
}

// What chooses one of several, where there is but one volume; `channels`: of those there may be
// several, which is looked at later.
Status refuseChoice(const std::string& path, const io::VoxelOptions& said, bool channels)
{
    if (said.dataset || said.dimensions)
        return {ErrorCode::VALUE_INVALID,
                path + " has one volume without a name: there is nothing to choose by option " +
                    (said.dataset ? "dataset" : "dimensions")};
    if (!channels && said.channel.value_or(0) > 0)
        return {ErrorCode::INDEX_OUT_OF_RANGE,
                path + " has no channel " + std::to_string(*said.channel) + ", but one"};
    return {};
}

// Of one file or a Zarr folder.
Result<io::Source> readFile(const std::string& path, const io::VoxelOptions& said,
                            const Progress& progress)
{
    const io::FileKind kind = io::fileKindOf(path);
    if (const auto formats = io::pluginFormatsOf(kind); !formats.empty())
        return io::readByPlugin(formats, requestOf(path, said));
    const bool image = kind == io::FileKind::IMAGE,
               pyramid = image && io::PyramidSource::isPyramid(path);
    if (Status status = refuseChoice(path, said, image && !pyramid); !status.ok()) return status;
    if (kind == io::FileKind::NUMPY) return io::readNumpy(path, progress);
    if (pyramid) return io::readPyramid(path);
    return io::readImage(path, said.channel, progress);
}

Result<io::Source> readSeries(const io::FoundVolume& found, const io::VoxelOptions& said)
{
    const auto open = [files = found.files, raw = found.raw, said](int step) {
        const std::string& path = files[std::size_t(step)];
        return raw ? io::readRaw(*raw, path, {}) : readFile(path, said, {});
    };
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    const CallerReports quiet;
    Status status = series->setSteps(static_cast<int>(found.files.size()), open);
    if (!status.ok()) return status;
    return io::Source(series);
}

// How a plugin is asked for all that was found, if it is a plugin's.
std::vector<io::PluginFormat> pluginsFor(const io::FoundVolume& found, const io::VoxelOptions& said,
                                         io::VolumeRequest& request)
{
    if (found.raw || said.series.value_or(false)) return {};
    request = requestOf(found.several ? found.path : found.files.front(), said);
    if (found.several) request.files = found.files;
    return io::pluginFormatsOf(io::fileKindOf(found.files.front()));
}

// Whether io::readImage() would be asked.
bool isImage(const io::FoundVolume& found, const io::VoxelOptions& said)
{
    const std::string& file = found.files.front();
    return !found.raw && !found.several && !said.series.value_or(false) &&
           io::fileKindOf(file) == io::FileKind::IMAGE && !io::PyramidSource::isPyramid(file);
}

Result<io::Source> readFound(const io::FoundVolume& found, const io::VoxelOptions& said,
                             const Progress& progress)
{
    if (said.series.value_or(false)) return readSeries(found, said);
    if (found.raw) {
        Status status = refuseChoice(found.files.front(), said, false);
        return status.ok() ? io::readRaw(*found.raw, found.files.front(), progress) : status;
    }
    if (!found.several) return readFile(found.files.front(), said, progress);
    io::VolumeRequest request;
    if (const auto formats = pluginsFor(found, said, request); !formats.empty())
        return io::readByPlugin(formats, request);
    if (Status status = refuseChoice(found.path, said, true); !status.ok()) return status;
    return io::readStack(found.files, said.channel, progress);
}

Status apply(Voxels& voxels, const io::VoxelOptions& options)
{
    Status status;
    if (options.spacing)
        status = voxels.setSpacing(
            osg::Vec3d(options.spacing->x, options.spacing->y, options.spacing->z));
    if (status.ok() && options.origin)
        status =
            voxels.setOrigin(osg::Vec3d(options.origin->x, options.origin->y, options.origin->z));
    if (status.ok() && options.range)
        status = voxels.setRange(osg::Vec2d(options.range->x, options.range->y));
    if (status.ok() && options.brick) {
        const glm::ivec3& brick = *options.brick;
        status = voxels.setBrickSize({brick.x, brick.y, brick.z});
    }
    if (status.ok() && options.overlap) status = voxels.setOverlap(*options.overlap);
    if (status.ok() && options.partial) status = voxels.setPartialBricks(*options.partial);
    return status;
}

/// The voxels of `source`, with what the option string says; `name` is for messages.
Result<osg::ref_ptr<Voxels>> makeVoxels(const Result<io::Source>& source,
                                        const io::VoxelOptions& options, const std::string& name)
{
    if (!source.ok()) return source.status;
    const CallerReports quiet;
    osg::ref_ptr<Voxels> voxels = new Voxels;
    Status status = voxels->setSource(source->get());
    if (status.ok()) status = apply(*voxels, options);
    if (!status.ok()) return Status(status.code, name + ": " + status.text, status.index);
    return voxels;
}

Result<io::VoxelOptions> optionsOf(const std::string& name, const osgDB::Options* options)
{
    const Result<io::VoxelOptions> said =
        io::parseVoxelOptions(options ? options->getOptionString() : std::string());
    if (!said.ok()) return Status(said.status.code, name + ": " + said.status.text);
    for (const std::string& option : said->foreign)
        OSG_INFO << "osgVolumizer: " << name << ": option \"" << option
                 << "\" is none of a volume's, and left to others" << std::endl;
    return said;
}

Result<osg::ref_ptr<Voxels>> read(const std::string& name, const osgDB::Options* options,
                                  const Progress& progress)
{
    const Result<io::VoxelOptions> said = optionsOf(name, options);
    if (!said.ok()) return said.status;
    const Result<io::FoundVolume> found =
        io::findVolume(name, options, said->series.value_or(false));
    if (!found.ok()) return found.status;
    Result<osg::ref_ptr<Voxels>> voxels =
        makeVoxels(readFound(*found, *said, progress), *said, name);
    if (!voxels.ok()) return voxels;
    (*voxels)->setFileName(name);
    (*voxels)->setFilePath(found->path);
    (*voxels)->setFileOptions(said->voxelText());
    return voxels;
}

Result<osg::ref_ptr<Voxels>> read(const std::vector<std::string>& names,
                                  const osgDB::Options* options, const Progress& progress)
{
    const Result<io::VoxelOptions> said =
        io::parseVoxelOptions(options ? options->getOptionString() : std::string());
    if (!said.ok()) return said.status;
    if (names.empty()) return Status(ErrorCode::VALUE_INVALID, "a stack of no slices");
    std::vector<std::string> paths;
    for (const std::string& name : names) {
        paths.push_back(osgDB::findDataFile(name, options));
        if (paths.back().empty())
            return Status(ErrorCode::FILE_NOT_FOUND, "slice " + name + " was not found",
                          static_cast<std::int64_t>(paths.size()) - 1);
    }
    return makeVoxels(readFound({paths.front(), paths, true, {}}, *said, progress), *said,
                      names.front());
}

Result<std::vector<VolumeEntry>> list(const std::string& name, const osgDB::Options* options)
{
    const Result<io::VoxelOptions> said = optionsOf(name, options);
    if (!said.ok()) return said.status;
    const Result<io::FoundVolume> found =
        io::findVolume(name, options, said->series.value_or(false));
    if (!found.ok()) return found.status;
    io::VolumeRequest request;
    if (const auto formats = pluginsFor(*found, *said, request); !formats.empty())
        return io::listByPlugin(formats, request);
    if (isImage(*found, *said)) {
        Result<VolumeEntry> image = io::listImage(found->files.front(), said->channel);
        if (!image.ok()) return image.status;
        image->chosen = true;
        return std::vector<VolumeEntry>{*image};
    }
    const Result<io::Source> source = readFound(*found, *said, {});
    if (!source.ok()) return source.status;
    VolumeEntry entry = io::entryOf(**source, "");
    entry.chosen = true;
    return std::vector<VolumeEntry>{entry};
}

} // namespace

Result<osg::ref_ptr<Voxels>> readVoxels(const std::string& name, const osgDB::Options* options,
                                        const Progress& progress)
{
    try {
        return read(name, options, progress);
    } catch (const std::exception& e) { // memory, or a path that the system cannot express
        return Status(ErrorCode::FILE_UNREADABLE, name + " cannot be read: " + e.what());
    }
}

Result<osg::ref_ptr<Voxels>> readSlices(const std::vector<std::string>& names,
                                        const osgDB::Options* options, const Progress& progress)
{
    try {
        return read(names, options, progress);
    } catch (const std::exception& e) {
        return Status(ErrorCode::FILE_UNREADABLE,
                      std::string("slices cannot be read: ") + e.what());
    }
}

Result<std::vector<VolumeEntry>> listVolumes(const std::string& name, const osgDB::Options* options)
{
    try {
        return list(name, options);
    } catch (const std::exception& e) {
        return Status(ErrorCode::FILE_UNREADABLE, name + " cannot be read: " + e.what());
    }
}

} // namespace osgVolumizer
