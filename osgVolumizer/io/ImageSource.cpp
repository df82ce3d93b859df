#include "ImageSource.h"

#include "../core/voxels/BrickTree.h"
#include "../core/voxels/VoxelData.h"

#include <algorithm>
#include <cstring>

namespace osgVolumizer {
namespace io {

Status ImageSource::open(const std::string& path, const Description& description,
                         const PixelFormat& format, std::vector<int> pages)
{
    auto shared = std::make_shared<Shared>();
    if (Status status = shared->file.open(path); !status.ok()) return status;
    _description = description;
    _format = format;
    _pages = std::move(pages);
    _file = std::move(shared);
    return {};
}

// Whole rows of a slice.
Status ImageSource::readRows(int z, int y, int end, std::vector<unsigned char>& rows) const
{
    const Description& d = _description;
    rows.resize(std::size_t(core::voxelBytes({d.size.x, end - y, 1}, d.type, d.components)));
    const std::lock_guard<std::mutex> lock(_file->mutex);
    if (!_file->file.seek(_pages[std::size_t(z)]))
        return {ErrorCode::FILE_UNREADABLE,
                _file->file.path() + ": slice " + std::to_string(z) + " cannot be found again"};
    return _file->file.readRows(_format, y, end, rows.data());
}

Status ImageSource::read(const core::Box3i& region, void* destination) const
{
    return readLevel(0, region, destination);
}

int ImageSource::levelCount() const
{
    return core::BrickTree::levelsFor(_description.size, pageSize());
}

Status ImageSource::readLevel(int level, const core::Box3i& region, void* destination) const
{
    constexpr int MOST_ROWS = 64;
    if (!_file) return {ErrorCode::VALUE_INVALID, "the voxel source has no file"};
    if (level < 0 || level >= levelCount())
        return VoxelSource::readLevel(std::max(level, 1), region, destination);
    if (region.empty()) return {};
    const Description& d = _description;
    if (Status status = checkRegion(region, core::BrickTree::levelSize(d.size, level));
        !status.ok())
        return status;
    const auto at = [&](int i, int axis) {
        const std::int64_t middle = level ? std::int64_t(1) << (level - 1) : 0;
        const std::int64_t place = (std::int64_t(i) << level) + middle;
        return static_cast<int>(std::min<std::int64_t>(place, d.size[axis] - 1));
    };
    const std::size_t voxel = voxelTypeSize(d.type) * std::size_t(d.components),
                      pitch = voxel * std::size_t(d.size.x);
    auto* to = static_cast<unsigned char*>(destination);
    std::vector<unsigned char> rows;
    for (int z = region.min.z; z < region.max.z; ++z)
        for (int y = region.min.y; y < region.max.y;) {
            // As many rows at once as lie near each other.
            const int first = at(y, 1);
            int end = y + 1;
            while (end < region.max.y && at(end, 1) - first < MOST_ROWS)
                ++end;
            Status status = readRows(at(z, 2), first, at(end - 1, 1) + 1, rows);
            if (!status.ok()) return status;
            for (; y < end; ++y) {
                const unsigned char* row = rows.data() + pitch * std::size_t(at(y, 1) - first);
                for (int x = region.min.x; x < region.max.x; ++x, to += voxel)
                    std::memcpy(to, row + voxel * std::size_t(at(x, 0)), voxel);
            }
        }
    return {};
}

} // namespace io
} // namespace osgVolumizer
