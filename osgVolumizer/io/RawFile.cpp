#include "RawVoxelSource.h"
#include "VoxelFiles.h"

#include "../core/RegularFile.h"
#include "../core/Text.h"

#include <filesystem>

namespace osgVolumizer {
namespace io {

namespace {

Status checkFileSize(const RawName& raw, const std::string& path)
{
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
    const osg::ref_ptr<RawVoxelSource> source = new RawVoxelSource;
    if (Status status = source->open(raw, path); !status.ok()) return status;
    if (progress) progress(1.0);
    return Source(source);
}

} // namespace io
} // namespace osgVolumizer
