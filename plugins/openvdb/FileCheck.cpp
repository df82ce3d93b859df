#include "FileCheck.h"

#include <osgVolumizer/core/RegularFile.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace osgVolumizer {
namespace vdb {

namespace {

constexpr std::uint32_t UUID_AS_TEXT = 218; // versions of the format
constexpr std::uint32_t COMPRESSION_OF_FILE = 220;
constexpr std::uint32_t COMPRESSION_OF_GRID = 222;

/// Reads what is in front of the grids, as long as it lies within the file.
class Walk
{
public:
    explicit Walk(const std::string& path)
        : _file(path, std::ios::binary),
          _size(static_cast<std::int64_t>(std::filesystem::file_size(path)))
    {
    }

    template <class T>
    T number()
    {
        T value{};
        if (!_file.read(reinterpret_cast<char*>(&value), sizeof(T))) fail();
        return value;
    }
    void skip(std::int64_t bytes) { seek(static_cast<std::int64_t>(_file.tellg()) + bytes); }
    void skipText() { skip(number<std::uint32_t>()); }
    void skipMetadata()
    {
        const auto count = number<std::uint32_t>();
        for (std::uint32_t i = 0; i < count; ++i) { // each takes 12 bytes or more, or ends this
            skipText();
            skipText();
            skipText();
        }
    }
    void seek(std::int64_t place)
    {
        if (place < 0 || place > _size || !_file.seekg(place)) fail();
    }
    std::int64_t size() const { return _size; }
    [[noreturn]] static void fail() { throw std::runtime_error("it is cut short or damaged"); }

private:
    std::ifstream _file;
    std::int64_t _size;
};

// A grid's name, type and place; the one behind it follows the grid.
void checkGrid(Walk& walk, std::uint32_t version)
{
    walk.skipText();
    walk.skipText();
    walk.skipText(); // the grid that this is an instance of
    const auto grid = walk.number<std::int64_t>(), blocks = walk.number<std::int64_t>(),
               end = walk.number<std::int64_t>();
    if (grid < 0 || blocks < grid || end < blocks || end > walk.size()) Walk::fail();
    walk.seek(grid);
    if (version >= COMPRESSION_OF_GRID) walk.number<std::uint32_t>();
    walk.skipMetadata();
    walk.seek(end);
}

void checkGrids(Walk& walk)
{
    walk.number<std::int64_t>(); // what the file is known by
    const auto version = walk.number<std::uint32_t>();
    if (version < UUID_AS_TEXT) return;
    walk.skip(8); // version of the library
    const bool hasPlaces = walk.number<char>() != 0;
    if (version >= COMPRESSION_OF_FILE && version < COMPRESSION_OF_GRID) walk.skip(1);
    walk.skip(36);
    walk.skipMetadata();
    if (!hasPlaces) throw std::runtime_error("it was written for streaming, without an index");
    const auto count = walk.number<std::int32_t>();
    for (std::int32_t i = 0; i < count; ++i)
        checkGrid(walk, version);
}

} // namespace

Status checkFile(const std::string& path)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    try {
        Walk walk(path);
        checkGrids(walk);
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + e.what()};
    }
    return {};
}

} // namespace vdb
} // namespace osgVolumizer
