#include "ReadVoxels.h"

#include "io/VoxelFiles.h"
#include "io/VoxelOptions.h"

#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <exception>

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

Result<io::Source> readFiles(const Result<std::vector<std::string>>& paths,
                             const Progress& progress)
{
    if (!paths.ok()) return paths.status;
    return io::readStack(*paths, progress);
}

Result<io::Source> readSource(std::string name, const osgDB::Options* options,
                              const Progress& progress)
{
    while (name.size() > 1 && name.back() == '/')
        name.pop_back();
    const std::string path = name.empty() ? name : osgDB::findDataFile(name, options);
    if (!path.empty()) {
        if (osgDB::fileType(path) == osgDB::DIRECTORY)
            return readFiles(io::listFolder(path), progress);
        return io::readImage(path, progress);
    }
    if (io::looksRaw(name)) {
        const Result<io::RawName> raw = io::parseRawName(name);
        if (!raw.ok()) return raw.status;
        const std::string rawPath = osgDB::findDataFile(raw->fileName, options);
        if (rawPath.empty())
            return Status(ErrorCode::FILE_NOT_FOUND,
                          "raw file " + raw->fileName + " was not found");
        return io::readRaw(*raw, rawPath, progress);
    }
    if (io::looksLikePattern(name))
        return readFiles(io::listPattern(name, searchFolders(options)), progress);
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
    if (status.ok() && options.brick) status = voxels.setBrickSize(*options.brick);
    return status;
}

Result<osg::ref_ptr<Voxels>> read(const std::string& name, const osgDB::Options* options,
                                  const Progress& progress)
{
    const Result<io::VoxelOptions> said =
        io::parseVoxelOptions(options ? options->getOptionString() : std::string());
    if (!said.ok()) return Status(said.status.code, name + ": " + said.status.text);
    const Result<io::Source> source = readSource(name, options, progress);
    if (!source.ok()) return source.status;
    osg::ref_ptr<Voxels> voxels = new Voxels;
    Status status = voxels->setSource(source->get());
    if (status.ok()) status = apply(*voxels, *said);
    if (!status.ok()) return Status(status.code, name + ": " + status.text, status.index);
    voxels->setFileName(name);
    voxels->setFileOptions(said->voxelText());
    return voxels;
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

} // namespace osgVolumizer
