#include "ScreenAreas.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

bool empty(const glm::ivec4& r)
{
    return r[2] <= 0 || r[3] <= 0;
}

glm::ivec4 fromEnds(int x0, int y0, int x1, int y1)
{
    return {x0, y0, x1 - x0, y1 - y0};
}

bool overlap(const glm::ivec4& a, const glm::ivec4& b)
{
    return a[0] < b[0] + b[2] && b[0] < a[0] + a[2] && a[1] < b[1] + b[3] && b[1] < a[1] + a[3];
}

void join(ScreenArea& a, const ScreenArea& b)
{
    const glm::ivec4 &r = a.rectangle, &s = b.rectangle;
    a.rectangle = fromEnds(std::min(r[0], s[0]), std::min(r[1], s[1]),
                           std::max(r[0] + r[2], s[0] + s[2]), std::max(r[1] + r[3], s[1] + s[3]));
    a.members.insert(a.members.end(), b.members.begin(), b.members.end());
}

// Joins the first overlapping pair; false if there is none.
bool joinOnePair(std::vector<ScreenArea>& areas)
{
    for (std::size_t i = 0; i < areas.size(); ++i) {
        for (std::size_t k = i + 1; k < areas.size(); ++k) {
            if (!overlap(areas[i].rectangle, areas[k].rectangle)) continue;
            join(areas[i], areas[k]);
            areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(k));
            return true;
        }
    }
    return false;
}

} // namespace

glm::ivec4 pixelRectangle(const ScreenRectangle& rectangle, const glm::ivec4& viewport, int margin)
{
    int ends[2][2];
    for (int axis = 0; axis < 2; ++axis) {
        const double size = viewport[2 + axis];
        const auto pixel = [&](double device) {
            return std::clamp(0.5 * (device + 1.0) * size, -1.0, size + 1.0);
        };
        const int low = static_cast<int>(std::floor(pixel(rectangle.min[axis]))) - margin;
        const int high = static_cast<int>(std::ceil(pixel(rectangle.max[axis]))) + margin;
        ends[0][axis] = viewport[axis] + std::max(low, 0);
        ends[1][axis] = viewport[axis] + std::min(high, viewport[2 + axis]);
    }
    return fromEnds(ends[0][0], ends[0][1], std::max(ends[0][0], ends[1][0]),
                    std::max(ends[0][1], ends[1][1]));
}

std::vector<ScreenArea> joinOverlapping(std::vector<ScreenArea> areas, std::size_t maximum)
{
    areas.erase(std::remove_if(areas.begin(), areas.end(),
                               [](const ScreenArea& a) { return empty(a.rectangle); }),
                areas.end());
    while (joinOnePair(areas)) {
    }
    if (areas.size() > maximum) {
        for (std::size_t i = 1; i < areas.size(); ++i)
            join(areas.front(), areas[i]);
        areas.resize(1);
    }
    return areas;
}

std::vector<glm::ivec4> subtract(const std::vector<glm::ivec4>& rectangles, const glm::ivec4& hole)
{
    std::vector<glm::ivec4> result;
    for (const glm::ivec4& r : rectangles) {
        if (!overlap(r, hole)) {
            result.push_back(r);
            continue;
        }
        const int x0 = r[0], y0 = r[1], x1 = r[0] + r[2], y1 = r[1] + r[3];
        const int hx0 = std::max(x0, hole[0]), hx1 = std::min(x1, hole[0] + hole[2]);
        const int hy0 = std::max(y0, hole[1]), hy1 = std::min(y1, hole[1] + hole[3]);
        for (const glm::ivec4& part : {fromEnds(x0, y0, x1, hy0), fromEnds(x0, hy1, x1, y1),
                                       fromEnds(x0, hy0, hx0, hy1), fromEnds(hx1, hy0, x1, hy1)})
            if (!empty(part)) result.push_back(part);
    }
    return result;
}

} // namespace render
} // namespace osgVolumizer
