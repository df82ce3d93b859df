#include "Hdf5Source.h"
#include "Selection.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/core/RegularFile.h>
#include <osgVolumizer/core/voxels/BrickTree.h>

#include <osg/Notify>

#include <exception>

#include <sys/stat.h>

namespace osgVolumizer {
namespace hdf5 {

namespace {

// Expects a Session: these are no constants.
hid_t nativeType(VoxelType type)
{
    switch (type) {
    case VoxelType::INT8:
        return H5T_NATIVE_INT8;
    case VoxelType::UINT8:
        return H5T_NATIVE_UINT8;
    case VoxelType::INT16:
        return H5T_NATIVE_INT16;
    case VoxelType::UINT16:
        return H5T_NATIVE_UINT16;
    case VoxelType::INT32:
        return H5T_NATIVE_INT32;
    case VoxelType::UINT32:
        return H5T_NATIVE_UINT32;
    default:
        return H5T_NATIVE_FLOAT;
    }
}

// Bytes of the file as it is now; -1 where that cannot be told.
std::int64_t bytesOf(hid_t file)
{
    void* descriptor = nullptr;
    struct stat found = {};
    if (H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor) < 0 || !descriptor ||
        ::fstat(*static_cast<const int*>(descriptor), &found) != 0)
        return -1;
    return found.st_size;
}

} // namespace

/// A file that is open for reading.
class Hdf5Source::File
{
public:
    explicit File(hid_t file) : _id(file), _bytes(bytesOf(file)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File()
    {
        const Session session;
        H5Fclose(_id);
    }
    hid_t id() const { return _id; }
    /// The library takes what is behind the end of a file for zeros.
    bool isCutShort() const { return bytesOf(_id) < _bytes; }

private:
    hid_t _id;
    std::int64_t _bytes;
};

Hdf5Source::Hdf5Source(const Hdf5Source& o, const osg::CopyOp& op)
    : VoxelSource(o, op), _path(o._path), _layout(o._layout), _levelCount(o._levelCount),
      _file(o._file)
{
}

Status Hdf5Source::refuse(ErrorCode code, const std::string& text) const
{
    return {code, _path + " cannot be read" + text};
}

Status Hdf5Source::open(const std::string& path, const Wanted& wanted)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    const Session session;
    _path = path;
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_sec2(access); // whatever the environment says: File has its descriptor
    const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
    if (id < 0) return refuse(ErrorCode::FILE_UNREADABLE, session.reason());
    _file = std::make_shared<const File>(id);
    Result<Layout> layout = findLayout(id, wanted);
    Status status = layout.ok() ? layout->description.validate() : layout.status;
    if (!status.ok()) return {status.code, path + ": " + status.text, status.index};
    _layout = *layout;
    for (const std::string& notice : _layout.notices)
        OSG_NOTICE << "osgVolumizer: " << path << ": " << notice << std::endl;
    const Description& d = _layout.description;
    const bool paged = _layout.levels.size() > 1 || _layout.steps > 1 ||
                       d.sizeInBytes() > getPagingBudget().memoryBytes / 2;
    _levelCount = paged ? core::BrickTree::levelsFor(d.size, pageSize()) : 1;
    return {};
}

Result<std::vector<VolumeEntry>> Hdf5Source::list() const
{
    const Session session;
    VolumeEntry own;
    const glm::ivec3 size = _layout.description.size;
    own.size = {size.x, size.y, size.z};
    own.type = _layout.description.type;
    own.channels = _layout.channels;
    own.steps = _layout.steps;
    own.chosen = true;
    if (isImaris(_file->id()) || isBigDataViewer(_file->id())) return std::vector<VolumeEntry>{own};
    const Result<std::vector<Dataset>> datasets = volumesOf(_file->id());
    if (!datasets.ok()) return Status(datasets.status.code, _path + ": " + datasets.status.text);
    std::vector<VolumeEntry> entries;
    for (const Dataset& dataset : *datasets) {
        const Result<Layout> layout = datasetLayout(_file->id(), {dataset.path, {}});
        if (!layout.ok()) continue;
        VolumeEntry entry = own;
        const glm::ivec3& n = layout->description.size;
        entry.name = dataset.path;
        entry.size = {n.x, n.y, n.z};
        entry.type = layout->description.type;
        entry.steps = layout->steps;
        entry.chosen = _layout.pathOf(0, 0) == dataset.path;
        entries.push_back(entry);
    }
    return entries;
}

Status Hdf5Source::readStep(int step, int level, const core::Box3i& region, void* destination) const
{
    if (!_file) return {ErrorCode::VALUE_INVALID, "the voxel source has no file"};
    if (region.empty()) return {};
    if (step < 0 || step >= _layout.steps)
        return VoxelSource::readStep(step < 1 ? 1 : step, level, region, destination);
    if (level < 0 || level >= _levelCount)
        return VoxelSource::readLevel(level < 1 ? 1 : level, region, destination);
    const glm::ivec3 size = core::BrickTree::levelSize(_layout.description.size, level);
    if (Status status = checkRegion(region, size); !status.ok()) return status;
    try {
        return readFrom(step, level, region, destination);
    } catch (const std::exception& e) {
        return refuse(ErrorCode::FILE_UNREADABLE, std::string(": ") + e.what());
    }
}

Status Hdf5Source::readFrom(int step, int level, const core::Box3i& region, void* destination) const
{
    const int fileLevel = _layout.fileLevelFor(level);
    const FileLevel& from = _layout.levels[std::size_t(fileLevel)];
    const Session session;
    const Result<Dataset> dataset = inspect(_file->id(), _layout.pathOf(step, fileLevel));
    if (!dataset.ok()) return {dataset.status.code, _path + ": " + dataset.status.text};
    // Time steps have datasets of their own, of which only the first was looked at.
    const int rank = static_cast<int>(dataset->size.size()), z = _layout.axes.z;
    for (int axis = 0; axis < 3; ++axis)
        if (z + 2 >= rank || dataset->size[std::size_t(z + 2 - axis)] < hsize_t(from.size[axis]))
            return refuse(ErrorCode::SIZE_MISMATCH,
                          ": dataset " + dataset->text() + " is smaller than that of time step 0");
    const Handle id(H5Dopen2(_file->id(), dataset->path.c_str(), H5P_DEFAULT), H5Dclose);
    const glm::ivec3 size = region.size();
    for (const Selection& selection : selectionsOf(region, level, from)) {
        const Handle inFile = selection.inFile(id, rank, _layout.axes, step);
        const Handle inMemory = selection.inMemory(size);
        if (H5Dread(id, nativeType(_layout.readAs), inMemory, inFile, H5P_DEFAULT, destination) < 0)
            return refuse(ErrorCode::FILE_UNREADABLE,
                          ": dataset " + oneLine(dataset->path) + session.reason());
    }
    if (_file->isCutShort())
        return refuse(ErrorCode::FILE_UNREADABLE, ": it was cut short meanwhile");
    return {};
}

} // namespace hdf5
} // namespace osgVolumizer
