#include "NumberFile.h"

#include <osgVolumizer/core/RegularFile.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

namespace osgVolumizer {
namespace medical {

namespace {

struct CloseGzip
{
    void operator()(gzFile_s* file) const { gzclose(file); }
};
using Gzip = std::unique_ptr<gzFile_s, CloseGzip>; // reads what is not packed as it is

bool isPacked(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return file.get() == 0x1f && file.get() == 0x8b;
}

} // namespace

std::string headOf(const std::string& path, std::size_t count)
{
    std::string head(count, '\0');
    const Gzip file(core::requireRegularFile(path).ok() ? gzopen(path.c_str(), "rb") : nullptr);
    const int found = file ? gzread(file.get(), head.data(), static_cast<unsigned>(count)) : 0;
    head.resize(static_cast<std::size_t>(std::max(found, 0)));
    return head;
}

Status checkBytes(const std::string& path, std::int64_t found, std::int64_t needed, bool packed)
{
    constexpr std::int64_t HIGHEST_FACTOR = 1040; // of deflate
    if (packed) needed /= HIGHEST_FACTOR;
    if (needed <= found) return {};
    return {ErrorCode::FILE_UNREADABLE,
            path + " has " + std::to_string(found) + " bytes, where its samples need " +
                (packed ? "even packed " : "") + std::to_string(needed)};
}

Status readNumbers(const std::string& path, std::int64_t offset, bool swapped, Samples& samples)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    std::error_code failed;
    const auto found = static_cast<std::int64_t>(std::filesystem::file_size(path, failed));
    const std::int64_t bytes = samples.bytes();
    const bool packed = isPacked(path);
    if (Status status = checkBytes(path, found - (packed ? 0 : offset), bytes, packed);
        !status.ok())
        return status;
    if (Status status = samples.allocate(); !status.ok())
        return {status.code, path + ' ' + status.text};
    const Gzip file(gzopen(path.c_str(), "rb"));
    bool whole = file && gzseek(file.get(), static_cast<z_off_t>(offset), SEEK_SET) == offset;
    for (std::int64_t done = 0; whole && done < bytes;) {
        const auto piece = static_cast<unsigned>(std::min<std::int64_t>(bytes - done, 1 << 26));
        const int count = gzread(file.get(), samples.data.get() + done, piece);
        whole = count > 0;
        done += std::max(count, 0);
    }
    if (!whole)
        return {ErrorCode::FILE_UNREADABLE, path + " is cut short or damaged within its samples"};
    const std::size_t size = numberSize(samples.number);
    if (swapped && size > 1)
        core::swapBytes(samples.data.get(), size, static_cast<std::size_t>(bytes) / size);
    return {};
}

} // namespace medical
} // namespace osgVolumizer
