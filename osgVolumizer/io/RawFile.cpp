#include "VoxelFiles.h"

#include "../core/RegularFile.h"
#include "../core/Text.h"
#include "../core/voxels/VoxelData.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace osgVolumizer {
namespace io {

namespace {

constexpr std::int64_t CHUNK_BYTES = 16 << 20; // between two reports of progress

bool hostIsBigEndian()
{
    const std::uint16_t one = 1;
    return *reinterpret_cast<const unsigned char*>(&one) == 0;
}

Status checkFileSize(const RawName& raw, const std::string& path)
{
    if (raw.fileBytes() > MemoryVoxelSource::DEFAULT_MAXIMUM_BYTES)
        return {ErrorCode::TOO_LARGE, path + ": " + core::formatTriple(raw.size) + " voxels of " +
                                          voxelTypeName(raw.type) + " are more than the bound of " +
                                          std::to_string(MemoryVoxelSource::DEFAULT_MAXIMUM_BYTES) +
                                          " bytes"};
    std::error_code failed;
    const std::uintmax_t found = std::filesystem::file_size(path, failed);
    if (failed) return {ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + failed.message()};
    const std::uintmax_t needed = static_cast<std::uintmax_t>(raw.fileBytes());
    if (found == needed) return {};
    return {found < needed ? ErrorCode::FILE_UNREADABLE : ErrorCode::SIZE_MISMATCH,
            path + " has " + std::to_string(found) + " bytes, where " +
                core::formatTriple(raw.size) + " voxels of " + voxelTypeName(raw.type) + " after " +
                std::to_string(raw.headerBytes) + " bytes of header need " +
                std::to_string(needed)};
}

} // namespace

Result<Source> readRaw(const RawName& raw, const std::string& path, const Progress& progress)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    if (Status status = checkFileSize(raw, path); !status.ok()) return status;
    VoxelSource::Description description;
    description.size = raw.size;
    description.type = raw.type;
    Source source = new MemoryVoxelSource;
    if (Status status = source->allocate(description); !status.ok())
        return Status(status.code, path + ": " + status.text);

    std::ifstream file(path, std::ios::binary);
    file.seekg(raw.headerBytes);
    const std::int64_t bytes = description.sizeInBytes();
    for (std::int64_t done = 0; done < bytes;) {
        const std::int64_t chunk = std::min(CHUNK_BYTES, bytes - done);
        char* to = static_cast<char*>(source->data()) + done;
        if (!file.read(to, chunk))
            return Status(ErrorCode::FILE_UNREADABLE,
                          path + " cannot be read beyond byte " +
                              std::to_string(raw.headerBytes + done + file.gcount()) + " of " +
                              std::to_string(raw.fileBytes()));
        if (raw.bigEndian != hostIsBigEndian()) {
            const std::size_t element = voxelTypeSize(raw.type);
            core::swapBytes(to, element, static_cast<std::size_t>(chunk) / element);
        }
        done += chunk;
        if (progress) progress(static_cast<double>(done) / static_cast<double>(bytes));
    }
    return source;
}

} // namespace io
} // namespace osgVolumizer
