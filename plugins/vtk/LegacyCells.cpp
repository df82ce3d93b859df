#include "LegacyCells.h"

#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <functional>

namespace osgVolumizer {
namespace vtk {

namespace {

Status damaged(const std::string& what)
{
    return {ErrorCode::FILE_UNREADABLE, "section CELLS " + what};
}

// The next number of a text, or of big-endian data; false where there is none.
using Next = std::function<bool(std::int64_t&)>;

Next numbersOf(const std::string& content, std::size_t at, bool binary)
{
    if (binary)
        return [&content, at](std::int64_t& value) mutable {
            if (at + 4 > content.size()) return false;
            std::uint32_t v = 0;
            for (int i = 0; i < 4; ++i)
                v = v << 8 | static_cast<unsigned char>(content[at++]);
            value = static_cast<std::int32_t>(v);
            return true;
        };
    return [&content, at](std::int64_t& value) mutable {
        char* end = nullptr;
        value = std::strtoll(content.c_str() + at, &end, 10);
        if (end == content.c_str() + at) return false;
        at = static_cast<std::size_t>(end - content.c_str());
        return true;
    };
}

// Whether the third line of the header says so.
bool isBinary(const std::string& content)
{
    std::size_t line = 0;
    for (int i = 0; i < 2 && line != std::string::npos; ++i)
        line = content.find('\n', line == 0 ? 0 : line + 1);
    const std::string word = content.substr(line == std::string::npos ? 0 : line + 1, 6);
    return word == "BINARY" || word == "binary";
}

} // namespace

Status checkLegacyCells(const std::string& content)
{
    std::size_t at = content.find("\nCELLS");
    if (at == std::string::npos) return {}; // VTK has words for that
    at += 6;
    std::int64_t cells = 0, size = 0;
    const Next head = numbersOf(content, at, false);
    if (!head(cells) || !head(size) || cells < 0 || size < 0)
        return damaged("does not say how many there are");
    at = content.find('\n', at);
    if (at == std::string::npos) return damaged("is empty");
    if (content.compare(++at, 7, "OFFSETS") == 0) return {}; // version 5, which VTK checks
    const Next next = numbersOf(content, at, isBinary(content));
    std::int64_t used = 0;
    for (std::int64_t c = 0; c < cells; ++c) {
        std::int64_t corners = 0, corner = 0;
        if (!next(corners) || corners < 0 || used + 1 + corners > size)
            return damaged("says that it has " + std::to_string(size) + " numbers, but cell " +
                           std::to_string(c) + " of " + std::to_string(cells) +
                           " reaches beyond them");
        for (std::int64_t i = 0; i < corners; ++i)
            if (!next(corner)) return damaged("ends in cell " + std::to_string(c));
        used += 1 + corners;
    }
    if (used == size) return {};
    return damaged("says that it has " + std::to_string(size) + " numbers instead of " +
                   std::to_string(used));
}

} // namespace vtk
} // namespace osgVolumizer
