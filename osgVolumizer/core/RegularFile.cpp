#include "RegularFile.h"

#include <filesystem>

namespace osgVolumizer {
namespace core {

namespace fs = std::filesystem;

Status requireRegularFile(const std::string& path)
{
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    if (status.type() == fs::file_type::not_found)
        return {ErrorCode::FILE_NOT_FOUND, path + " was not found"};
    if (status.type() == fs::file_type::none)
        return {ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + failed.message()};
    if (status.type() != fs::file_type::regular)
        return {ErrorCode::FILE_UNREADABLE, path + " is no regular file"};
    return {};
}

Status requireRegularTarget(const std::string& path)
{
    Status status = requireRegularFile(path);
    return status.code == ErrorCode::FILE_NOT_FOUND ? Status() : status;
}

} // namespace core
} // namespace osgVolumizer
