#include "LegacyCells.h"

#include "FaceStream.h"
#include "LegacyNumbers.h"

#include <vtkCellType.h>

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

// Version 5, of which VTK checks all but the polyhedra.
void findOffsets(Layout& layout, std::size_t offsets)
{
    layout.offsets = true;
    layout.sizeBytes = bytesOf(layout, offsets);
    layout.sizesAt = nextLine(layout.content, offsets);
    LegacyNumbers numbers(layout.content, layout.sizesAt, layout.sizeBytes);
    numbers.skip(layout.cells);
    const std::size_t points = behind(layout.content, "CONNECTIVITY", numbers.place() - 1);
    layout.pointBytes = points == NOWHERE ? 0 : bytesOf(layout, points);
    layout.pointsAt = nextLine(layout.content, points);
    layout.end = layout.pointsAt;
    --layout.cells; // there is an offset more
}

} // namespace

Status checkLegacyCells(const std::string& content)
{
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
    if (strncasecmp(content.c_str() + layout.sizesAt, "OFFSETS", 7) == 0)
        findOffsets(layout, layout.sizesAt);
    else if (Status sizes = checkSizes(layout); !sizes)
        return sizes;
    return checkPolyhedra(layout);
}

} // namespace vtk
} // namespace osgVolumizer
