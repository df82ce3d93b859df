#include "RawVoxelSource.h"

#include "../Paging.h"
#include "../core/voxels/BrickTree.h"
#include "../core/voxels/VoxelData.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace osgVolumizer {
namespace io {

namespace {

// Rows shorter than this are read together with what lies between them, in pieces of a buffer.
constexpr std::int64_t LONG_ROW = 16 << 10, BUFFER_BYTES = 1 << 20;

bool hostIsBigEndian()
{
    const std::uint16_t one = 1;
    return *reinterpret_cast<const unsigned char*>(&one) == 0;
}

} // namespace

/// A descriptor of a file that is open for reading.
class RawVoxelSource::File
{
public:
    explicit File(const std::string& path) : _descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC))
    {
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File()
    {
        if (_descriptor >= 0) ::close(_descriptor);
    }
    int descriptor() const { return _descriptor; }

private:
    int _descriptor;
};

RawVoxelSource::RawVoxelSource(const RawVoxelSource& o, const osg::CopyOp& op)
    : VoxelSource(o, op), _description(o._description), _path(o._path),
      _headerBytes(o._headerBytes), _fileBytes(o._fileBytes), _levels(o._levels),
      _sliceStep(o._sliceStep), _swaps(o._swaps), _file(o._file)
{
}

Status RawVoxelSource::open(const RawName& raw, const std::string& path)
{
    Description description;
    description.size = raw.size;
    description.type = raw.type;
    if (Status status = description.validate(); !status.ok()) return status;
    auto file = std::make_shared<const File>(path);
    if (file->descriptor() < 0)
        return {ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + std::strerror(errno)};
    _description = description;
    _path = path;
    _headerBytes = raw.headerBytes;
    _fileBytes = raw.fileBytes();
    _levels = description.sizeInBytes() > getPagingBudget().memoryBytes / 2
                  ? core::BrickTree::levelsFor(raw.size, pageSize())
                  : 1;
    _sliceStep = raw.sliceStep;
    _swaps = raw.bigEndian != hostIsBigEndian() && voxelTypeSize(raw.type) > 1;
    _file = std::move(file);
    return {};
}

Status RawVoxelSource::readBytes(std::int64_t offset, std::int64_t bytes, void* destination) const
{
    auto* to = static_cast<unsigned char*>(destination);
    for (std::int64_t done = 0; done < bytes;) {
        const ssize_t got =
            ::pread(_file->descriptor(), to + done, static_cast<std::size_t>(bytes - done),
                    static_cast<off_t>(_headerBytes + offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            return {ErrorCode::FILE_UNREADABLE,
                    _path + " cannot be read beyond byte " +
                        std::to_string(_headerBytes + offset + done) + " of " +
                        std::to_string(_fileBytes) +
                        (got < 0 ? std::string(": ") + std::strerror(errno) : std::string())};
        done += got;
    }
    return {};
}

// The part of slice z, tightly packed.
Status RawVoxelSource::readLayer(const core::Box3i& region, int z, unsigned char* destination) const
{
    const glm::ivec3& all = _description.size;
    const auto voxel = static_cast<std::int64_t>(voxelTypeSize(_description.type));
    const std::int64_t row = region.size().x * voxel, pitch = all.x * voxel;
    const auto offsetOf = [&](int y) {
        return ((std::int64_t(z) * _sliceStep * all.y + y) * all.x + region.min.x) * voxel;
    };
    const int rows = region.size().y;
    if (row == pitch) return readBytes(offsetOf(region.min.y), row * rows, destination);
    const int step =
        row >= LONG_ROW ? 1 : static_cast<int>(std::max<std::int64_t>(BUFFER_BYTES / pitch, 1));
    std::vector<unsigned char> buffer;
    for (int y = 0; y < rows; y += step) {
        const int count = std::min(step, rows - y);
        unsigned char* to = destination + y * row;
        const std::int64_t bytes = (count - 1) * pitch + row;
        if (count > 1) buffer.resize(static_cast<std::size_t>(bytes));
        Status status =
            readBytes(offsetOf(region.min.y + y), bytes, count > 1 ? buffer.data() : to);
        if (!status.ok()) return status;
        for (int i = 0; count > 1 && i < count; ++i)
            std::memcpy(to + i * row, buffer.data() + i * pitch, static_cast<std::size_t>(row));
    }
    return {};
}

Status RawVoxelSource::read(const core::Box3i& region, void* destination) const
{
    if (!_file) return {ErrorCode::VALUE_INVALID, "the voxel source has no file"};
    if (region.empty()) return {};
    if (Status status = checkRegion(region, _description.size); !status.ok()) return status;
    auto* to = static_cast<unsigned char*>(destination);
    const std::int64_t element = static_cast<std::int64_t>(voxelTypeSize(_description.type));
    const std::int64_t layer = element * region.size().x * region.size().y;
    for (int z = region.min.z; z < region.max.z; ++z, to += layer) {
        if (Status status = readLayer(region, z, to); !status.ok()) return status;
        if (_swaps)
            core::swapBytes(to, static_cast<std::size_t>(element),
                            static_cast<std::size_t>(layer / element));
    }
    return {};
}

Status RawVoxelSource::readLevel(int level, const core::Box3i& region, void* destination) const
{
    if (level <= 0 || level >= _levels) return VoxelSource::readLevel(level, region, destination);
    return readThinned(level, region, destination);
}

} // namespace io
} // namespace osgVolumizer
