#include "FindVolume.h"

#include "FileKind.h"
#include "VoxelFiles.h"

#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <filesystem>

namespace osgVolumizer {
namespace io {

namespace {

namespace fs = std::filesystem;

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
    return (fs::absolute(path).parent_path() / fs::path(name).filename()).string();
}

bool isFolder(const std::string& path)
{
    std::error_code unknown; // OSG takes sockets for folders
    return fs::is_directory(path, unknown) && fileKindOf(path) != FileKind::ZARR;
}

Result<FoundVolume> several(const Result<std::vector<std::string>>& files, const std::string& path,
                            const std::string& name)
{
    if (!files.ok()) return files.status;
    FoundVolume found;
    found.files = *files;
    found.several = true;
    found.path = inFolderOf(path.empty() ? files->front() : path, name);
    return found;
}

Status notFound(const std::string& name)
{
    return {ErrorCode::FILE_NOT_FOUND, "volume \"" + name + "\" was not found"};
}

// Each of them raw, if that stands in the name.
Result<FoundVolume> findSteps(const std::string& name, const osgDB::Options* options)
{
    std::optional<RawName> raw;
    std::string files = name;
    if (looksRaw(name)) {
        const Result<RawName> parsed = parseRawName(name);
        if (!parsed.ok()) return parsed.status;
        raw = *parsed;
        files = parsed->fileName;
    }
    const bool pattern = looksLikePattern(files);
    const std::string path = pattern ? "" : osgDB::findDataFile(files, options);
    if (!pattern && path.empty()) return notFound(files);
    if (!pattern && !isFolder(path))
        return Status(ErrorCode::VALUE_INVALID,
                      "a series of time steps is a folder or a pattern such as name%03d.tif");
    Result<FoundVolume> found = several(
        pattern ? listPattern(files, searchFolders(options)) : listFolder(path, true), path, name);
    if (found.ok()) found->raw = raw;
    return found;
}

Result<FoundVolume> findRaw(const std::string& name, const osgDB::Options* options)
{
    const Result<RawName> raw = parseRawName(name);
    if (!raw.ok()) return raw.status;
    const std::string path = osgDB::findDataFile(raw->fileName, options);
    if (path.empty())
        return Status(ErrorCode::FILE_NOT_FOUND, "raw file " + raw->fileName + " was not found");
    return FoundVolume{inFolderOf(path, name), {path}, false, *raw};
}

} // namespace

Result<FoundVolume> findVolume(std::string name, const osgDB::Options* options, bool steps)
{
    while (name.size() > 1 && name.back() == '/')
        name.pop_back();
    if (steps) return findSteps(name, options);
    const std::string path = name.empty() ? name : osgDB::findDataFile(name, options);
    if (!path.empty() && isFolder(path)) return several(listFolder(path), path, name);
    if (!path.empty()) return FoundVolume{inFolderOf(path, name), {path}, false, {}};
    if (looksRaw(name)) return findRaw(name, options);
    if (looksLikePattern(name)) return several(listPattern(name, searchFolders(options)), "", name);
    return notFound(name);
}

} // namespace io
} // namespace osgVolumizer
