#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include <unistd.h>

namespace osgVolumizer {
namespace fuzz {

/// A file of this process, written anew for each input, for readers that take names.
class TemporaryFile
{
public:
    explicit TemporaryFile(const char* name)
        : _path((std::filesystem::temp_directory_path() /
                 (name + std::to_string(static_cast<long>(::getpid()))))
                    .string())
    {
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile()
    {
        std::error_code ignored;
        std::filesystem::remove(_path, ignored);
    }
    void write(const unsigned char* data, std::size_t size) const
    {
        if (std::FILE* file = std::fopen(_path.c_str(), "wb")) {
            std::fwrite(data, 1, size, file);
            std::fclose(file);
        }
    }
    const std::string& path() const { return _path; }

private:
    std::string _path;
};

} // namespace fuzz
} // namespace osgVolumizer
