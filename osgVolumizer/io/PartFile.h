#pragma once

#include "../core/Status.h"

#include <filesystem>
#include <string>

namespace osgVolumizer {
namespace io {

/// A file of another name beside the target, which takes its place when it is whole.
class PartFile
{
public:
    enum Rest
    {
        REMOVED, ///< what is not whole goes
        STAYS    ///< it can be gone on with
    };

    explicit PartFile(const std::string& target, Rest rest = REMOVED)
        : _target(target), _part(std::filesystem::path(target).replace_extension(
                               ".part" + std::filesystem::path(target).extension().string())),
          _rest(rest)
    {
    }
    ~PartFile()
    {
        std::error_code ignored;
        if (!_kept && _rest == REMOVED) std::filesystem::remove(_part, ignored);
    }
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    std::string name() const { return _part.string(); }
    Status keep()
    {
        std::error_code failed;
        std::filesystem::rename(_part, _target, failed);
        if (failed)
            return {ErrorCode::FILE_UNREADABLE,
                    _target.string() + " cannot be written: " + failed.message()};
        _kept = true;
        return {};
    }

private:
    std::filesystem::path _target, _part;
    Rest _rest;
    bool _kept = false;
};

} // namespace io
} // namespace osgVolumizer
