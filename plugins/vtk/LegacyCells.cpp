#include "LegacyCells.h"

#include "FaceStream.h"
#include "LegacyNumbers.h"

#include <vtkCellType.h>

#include <cstdio>

#include <strings.h>

namespace osgVolumizer {
namespace vtk {

namespace {

constexpr std::size_t NOWHERE = std::string::npos;

Status damaged(const std::string& what)
{
    return {ErrorCode::FILE_UNREADABLE, "section CELLS " + what};
}

// Behind a keyword at the beginning of a line, in whatever case, as VTK takes them.
std::size_t behind(const std::string& content, const std::string& keyword, std::size_t from)
{
    for (std::size_t at = content.find('\n', from); at != NOWHERE; at = content.find('\n', at + 1))
        if (strncasecmp(content.c_str() + at + 1, keyword.c_str(), keyword.size()) == 0)
            return at + 1 + keyword.size();
    return NOWHERE;
}

std::size_t nextLine(const std::string& content, std::size_t at)
{
    const std::size_t end = at == NOWHERE ? NOWHERE : content.find('\n', at);
    return end == NOWHERE ? content.size() : end + 1;
}

// Whether the third line of the header says so.
bool isBinary(const std::string& content)
{
    const std::size_t line = nextLine(content, nextLine(content, 0));
    return strncasecmp(content.c_str() + line, "binary", 6) == 0;
}

// As VTK reads it, which decides by it what to expect.
bool isVersion5(const std::string& content)
{
    constexpr std::size_t PREFIX = 23; // "# vtk DataFile Version "
    int major = 0, minor = 0;
    const std::string line = content.substr(0, content.find('\n'));
    return line.size() > PREFIX &&
           std::sscanf(line.c_str() + PREFIX, "%d.%d", &major, &minor) == 2 && major >= 5;
}

/// Where the numbers of a file's cells are: of each its size and its points, or (version 5) where
/// each ends among the points of all.
struct Layout
{
    const std::string& content;
    bool binary = false, offsets = false;
    std::int64_t cells = 0, size = 0;
    std::size_t sizesAt = 0, pointsAt = 0;
    int sizeBytes = 0, pointBytes = 0;
    std::size_t end = 0;
};

// The size of cell by cell.
class Sizes
{
public:
    explicit Sizes(const Layout& layout)
        : _numbers(layout.content, layout.sizesAt, layout.sizeBytes), _offsets(layout.offsets)
    {
        if (_offsets) _numbers(_last);
    }
    bool next(std::int64_t& size)
    {
        std::int64_t number = 0;
        if (!_numbers(number)) return false;
        size = _offsets ? number - _last : number;
        _last = number;
        return size >= 0;
    }
    LegacyNumbers& numbers() { return _numbers; }

private:
    LegacyNumbers _numbers;
    bool _offsets;
    std::int64_t _last = 0;
};

// VTK walks over the faces of polyhedra, too, as far as they say that they reach.
Status checkPolyhedra(const Layout& layout)
{
    std::size_t at = behind(layout.content, "CELL_TYPES", layout.end);
    if (at == NOWHERE) at = behind(layout.content, "CELL_TYPES", 0);
    if (at == NOWHERE) return {}; // VTK has words for that
    LegacyNumbers types(layout.content, nextLine(layout.content, at), layout.binary ? 4 : 0);
    Sizes sizes(layout);
    LegacyNumbers separate(layout.content, layout.pointsAt, layout.pointBytes);
    LegacyNumbers& points = layout.offsets ? separate : sizes.numbers();
    for (std::int64_t c = 0; c < layout.cells; ++c) {
        std::int64_t type = 0, left = 0;
        if (!types(type) || !sizes.next(left)) return {};
        const auto next = [&](std::int64_t& value) { return left-- > 0 && points(value); };
        if (type == VTK_POLYHEDRON && !(skipFaces(next) && left == 0))
            return damaged("has faces that do not end with cell " + std::to_string(c));
        if (!points.skip(left)) return {};
    }
    return {};
}

// Before version 5. VTK takes the sum on trust.
Status checkSizes(Layout& layout)
{
    LegacyNumbers next(layout.content, layout.sizesAt, layout.sizeBytes);
    std::int64_t used = 0;
    for (std::int64_t c = 0; c < layout.cells; ++c) {
        std::int64_t corners = 0;
        if (!next(corners) || corners < 0 || corners >= layout.size - used)
            return damaged("says that it has " + std::to_string(layout.size) +
                           " numbers, but cell " + std::to_string(c) + " of " +
                           std::to_string(layout.cells) + " reaches beyond them");
        if (!next.skip(corners)) return damaged("ends in cell " + std::to_string(c));
        used += 1 + corners;
    }
    layout.end = next.place();
    if (used == layout.size) return {};
    return damaged("says that it has " + std::to_string(layout.size) + " numbers instead of " +
                   std::to_string(used));
}

int bytesOf(const Layout& layout, std::size_t at)
{
    if (!layout.binary) return 0;
    const std::string line = layout.content.substr(at, nextLine(layout.content, at) - at);
    return line.find("64") != NOWHERE || line.find("long") != NOWHERE ? 8 : 4;
}

// Version 5.
Status checkOffsets(Layout& layout, std::size_t offsets)
{
    layout.offsets = true;
    layout.sizeBytes = bytesOf(layout, offsets);
    layout.sizesAt = nextLine(layout.content, offsets);
    LegacyNumbers next(layout.content, layout.sizesAt, layout.sizeBytes);
    std::int64_t last = 0, offset = 0;
    for (std::int64_t c = 0; c < layout.cells; ++c, last = offset)
        if (!next(offset) || offset < last || (c == 0 && offset != 0))
            return damaged("has no offset " + std::to_string(c) + " of " +
                           std::to_string(layout.cells) + " that follows the others");
    if (last != layout.size)
        return damaged("has offsets up to " + std::to_string(last) + " of " +
                       std::to_string(layout.size));
    const std::size_t points = behind(layout.content, "CONNECTIVITY", next.place() - 1);
    if (points == NOWHERE) return damaged("has no CONNECTIVITY");
    layout.pointBytes = bytesOf(layout, points);
    layout.pointsAt = nextLine(layout.content, points);
    LegacyNumbers connectivity(layout.content, layout.pointsAt, layout.pointBytes);
    if (!connectivity.skip(layout.size)) return damaged("has too few points in CONNECTIVITY");
    layout.end = connectivity.place();
    if (layout.cells > 0) --layout.cells; // there is an offset more
    return {};
}

// Every number in the file takes a byte at least.
Status checkCounts(const std::string& content)
{
    for (const char* section : {"POINTS", "CELL_TYPES", "POINT_DATA", "CELL_DATA"}) {
        const std::size_t at = behind(content, section, 0);
        std::int64_t count = 0;
        if (at == NOWHERE || !LegacyNumbers(content, at, 0)(count)) continue;
        if (count < 0 || static_cast<std::uint64_t>(count) > content.size())
            return {ErrorCode::FILE_UNREADABLE, std::string("section ") + section +
                                                    " cannot have " + std::to_string(count) +
                                                    " entries"};
    }
    return {};
}

} // namespace

Status checkLegacyCells(const std::string& content)
{
    if (Status counts = checkCounts(content); !counts) return counts;
    const std::size_t at = behind(content, "CELLS", 0);
    if (at == NOWHERE) return {}; // VTK has words for that
    Layout layout{content};
    layout.binary = isBinary(content);
    LegacyNumbers head(content, at, 0);
    if (!head(layout.cells) || !head(layout.size) || layout.cells < 0 || layout.size < 0)
        return damaged("does not say how many there are");
    layout.sizesAt = nextLine(content, at);
    if (layout.sizesAt >= content.size()) return damaged("is empty");
    layout.sizeBytes = layout.binary ? 4 : 0;
    const bool offsets = strncasecmp(content.c_str() + layout.sizesAt, "OFFSETS", 7) == 0;
    if (offsets != isVersion5(content)) return damaged("is not what the file's version has");
    const Status status = offsets ? checkOffsets(layout, layout.sizesAt) : checkSizes(layout);
    return status.ok() ? checkPolyhedra(layout) : status;
}

} // namespace vtk
} // namespace osgVolumizer
