#include "ReadVoxels.h"

#include "VoxelSeries.h"
#include "io/PluginFile.h"
#include "io/PyramidSource.h"
#include "io/VoxelFiles.h"
#include "io/VoxelOptions.h"

#include <osg/Notify>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <exception>
#include <filesystem>
#include <optional>

namespace osgVolumizer {

namespace {

std::vector<std::string> searchFolders(const osgDB::Options* options)
{
    std::vector<std::string> folders;
    if (options)
        folders.assign(options->getDatabasePathList().begin(),
                       options->getDatabasePathList().end());
    const osgDB::FilePathList& global = osgDB::Registry::instance()->getDataFilePathList();
    folders.insert(folders.end(), global.begin(), global.end());
    return folders;
}

// The name of a volume in the folder that it was found in.
std::string inFolderOf(const std::string& path, const std::string& name)
{
    namespace fs = std::filesystem;
    return (fs::absolute(path).parent_path() / fs::path(name).filename()).string();
}

Result<io::Source> readFiles(const Result<std::vector<std::string>>& paths,
                             const Progress& progress)
{
    if (!paths.ok()) return paths.status;
    return io::readStack(*paths, progress);
}

// One file that was found. Raw files are found by readSource().
Result<io::Source> readFile(const std::string& path, const io::VoxelOptions& said,
                            const Progress& progress)
{
    if (const io::PluginFormat* format = io::pluginFormatOf(path))
        return io::readByPlugin(*format, path, said);
    if (io::PyramidSource::isPyramid(path)) return io::readPyramid(path);
    return io::readImage(path, progress);
}

// The files of a name that stands for several, and for raw ones what they are.
Result<std::vector<std::string>> listSteps(const std::string& name, const osgDB::Options* options,
                                           std::optional<io::RawName>& raw)
{
    std::string files = name;
    if (io::looksRaw(name)) {
        const Result<io::RawName> parsed = io::parseRawName(name);
        if (!parsed.ok()) return parsed.status;
        raw = *parsed;
        files = parsed->fileName;
    }
    if (io::looksLikePattern(files)) return io::listPattern(files, searchFolders(options));
    const std::string path = osgDB::findDataFile(files, options);
    std::error_code unknown;
    if (path.empty())
        return Status(ErrorCode::FILE_NOT_FOUND, "volume \"" + files + "\" was not found");
    if (!std::filesystem::is_directory(path, unknown))
        return Status(ErrorCode::VALUE_INVALID,
                      "a series of time steps is a folder or a pattern such as name%03d.tif");
    return io::listFolder(path, true);
}

Result<io::Source> readSeries(const std::string& name, const osgDB::Options* options,
                              const io::VoxelOptions& said, std::string& found)
{
    std::optional<io::RawName> raw;
    const Result<std::vector<std::string>> paths = listSteps(name, options, raw);
    if (!paths.ok()) return paths.status;
    found = inFolderOf(paths->front(), name);
    const auto open = [paths = *paths, raw, said](int step) {
        const std::string& path = paths[std::size_t(step)];
        return raw ? io::readRaw(*raw, path, {}) : readFile(path, said, {});
    };
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    const CallerReports quiet;
    Status status = series->setSteps(static_cast<int>(paths->size()), open);
    if (!status.ok()) return status;
    return io::Source(series);
}

// Also finds the absolute name of the volume.
Result<io::Source> readSource(std::string name, const osgDB::Options* options,
                              const io::VoxelOptions& said, const Progress& progress,
                              std::string& found)
{
    while (name.size() > 1 && name.back() == '/')
        name.pop_back();
    if (said.series.value_or(false)) return readSeries(name, options, said, found);
    const std::string path = name.empty() ? name : osgDB::findDataFile(name, options);
    if (!path.empty()) {
        found = inFolderOf(path, name);
        std::error_code unknown; // OSG takes sockets for folders
        if (std::filesystem::is_directory(path, unknown))
            return readFiles(io::listFolder(path), progress);
        Result<io::Source> source = readFile(path, said, progress);
        if (source.ok() && io::isSliceOfSeries(path))
            OSG_NOTICE << "osgVolumizer: " << path << " is one slice of a series; the name of its "
                       << "folder opens all that lie there" << std::endl;
        return source;
    }
    if (io::looksRaw(name)) {
        const Result<io::RawName> raw = io::parseRawName(name);
        if (!raw.ok()) return raw.status;
        const std::string rawPath = osgDB::findDataFile(raw->fileName, options);
        if (rawPath.empty())
            return Status(ErrorCode::FILE_NOT_FOUND,
                          "raw file " + raw->fileName + " was not found");
        found = inFolderOf(rawPath, name);
        return io::readRaw(*raw, rawPath, progress);
    }
    if (io::looksLikePattern(name)) {
        const Result<std::vector<std::string>> files =
            io::listPattern(name, searchFolders(options));
        if (files.ok() && !files->empty()) found = inFolderOf(files->front(), name);
        return readFiles(files, progress);
    }
    return Status(ErrorCode::FILE_NOT_FOUND, "volume \"" + name + "\" was not found");
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

Result<osg::ref_ptr<Voxels>> read(const std::string& name, const osgDB::Options* options,
                                  const Progress& progress)
{
    const Result<io::VoxelOptions> said =
        io::parseVoxelOptions(options ? options->getOptionString() : std::string());
    if (!said.ok()) return Status(said.status.code, name + ": " + said.status.text);
    for (const std::string& option : said->foreign)
        OSG_INFO << "osgVolumizer: " << name << ": option \"" << option
                 << "\" is none of a volume's, and left to others" << std::endl;
    std::string found;
    Result<osg::ref_ptr<Voxels>> voxels =
        makeVoxels(readSource(name, options, *said, progress, found), *said, name);
    if (!voxels.ok()) return voxels;
    (*voxels)->setFileName(name);
    (*voxels)->setFilePath(found);
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
    return makeVoxels(io::readStack(paths, progress), *said, names.front());
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

} // namespace osgVolumizer
