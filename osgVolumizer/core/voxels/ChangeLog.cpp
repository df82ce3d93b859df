#include "ChangeLog.h"

#include "VoxelData.h"

#include <glm/common.hpp>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace osgVolumizer {
namespace core {

namespace {

const glm::ivec3 LINE(16, 2, 2);
constexpr std::int64_t MANY_SAMPLES = std::int64_t(1) << 22;
// How many samples more than both a box around two may have to stand for them.
constexpr double WASTE = 1.03;

Box3i around(const Box3i& a, const Box3i& b)
{
    return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

Box3i around(const std::vector<Box3i>& boxes)
{
    Box3i all = boxes.front();
    for (const Box3i& box : boxes)
        all = around(all, box);
    return all;
}

// Lines by their places: z, y, x.
using Lines = std::map<std::tuple<int, int, int>, Box3i>;

void addToLines(const Box3i& box, Lines& lines)
{
    const glm::ivec3 first = box.min / LINE, last = (box.max - 1) / LINE;
    glm::ivec3 c;
    for (c.z = first.z; c.z <= last.z; ++c.z)
        for (c.y = first.y; c.y <= last.y; ++c.y)
            for (c.x = first.x; c.x <= last.x; ++c.x) {
                const Box3i part = intersection(box, {c * LINE, (c + 1) * LINE});
                const auto added = lines.emplace(std::make_tuple(c.z, c.y, c.x), part);
                if (!added.second) added.first->second = around(added.first->second, part);
            }
}

// Joins boxes along an axis. Expects them in the order of that axis; keeps it.
std::vector<Box3i> joined(const std::vector<Box3i>& boxes, int axis)
{
    std::vector<Box3i> result;
    std::size_t open = 0; // those before end too early
    for (const Box3i& box : boxes) {
        while (open < result.size() && result[open].max[axis] < box.min[axis])
            ++open;
        bool found = false;
        for (std::size_t i = result.size(); i > open && !found; --i) {
            Box3i& other = result[i - 1];
            if (other.max[axis] != box.min[axis]) continue;
            const Box3i both = around(other, box);
            const double samples =
                double(sampleCount(other.size())) + double(sampleCount(box.size()));
            found = double(sampleCount(both.size())) <= WASTE * samples;
            if (found) other = both;
        }
        if (!found) result.push_back(box);
    }
    return result;
}

void sortAlong(std::vector<Box3i>& boxes, int axis)
{
    std::stable_sort(boxes.begin(), boxes.end(),
                     [axis](const Box3i& a, const Box3i& b) { return a.min[axis] < b.min[axis]; });
}

} // namespace

std::vector<Box3i> coveringBoxes(const std::vector<Box3i>& boxes)
{
    std::int64_t samples = 0;
    for (const Box3i& box : boxes)
        samples += sampleCount(box.size());
    if (samples > MANY_SAMPLES) return {around(boxes)};
    Lines lines;
    for (const Box3i& box : boxes)
        if (!box.empty()) addToLines(box, lines);
    std::vector<Box3i> result;
    std::vector<Box3i> layer; // boxes of lines at one z
    for (auto line = lines.begin(); line != lines.end();) {
        const int z = std::get<0>(line->first);
        layer.clear();
        while (line != lines.end() && std::get<0>(line->first) == z) {
            const int y = std::get<1>(line->first);
            std::vector<Box3i> row;
            for (; line != lines.end() && std::get<0>(line->first) == z &&
                   std::get<1>(line->first) == y;
                 ++line)
                row.push_back(line->second);
            row = joined(row, 0);
            layer.insert(layer.end(), row.begin(), row.end());
        }
        sortAlong(layer, 1);
        layer = joined(layer, 1);
        result.insert(result.end(), layer.begin(), layer.end());
    }
    sortAlong(result, 2);
    return joined(result, 2);
}

std::vector<Box3i> clipped(const std::vector<Box3i>& boxes, const Box3i& within)
{
    return grown(boxes, 0, within);
}

std::vector<Box3i> grown(const std::vector<Box3i>& boxes, int margin, const Box3i& within)
{
    std::vector<Box3i> result;
    result.reserve(boxes.size());
    for (const Box3i& box : boxes) {
        const Box3i part = intersection({box.min - margin, box.max + margin}, within);
        if (!part.empty()) result.push_back(part);
    }
    return result;
}

void ChangeLog::add(std::vector<Box3i> boxes, unsigned count)
{
    _boxCount += boxes.size();
    _changes.push_back({count, std::move(boxes)});
    while (_boxCount > MAXIMUM_BOXES) {
        _knownFrom = _changes.front().count;
        _boxCount -= _changes.front().boxes.size();
        _changes.pop_front();
    }
}

void ChangeLog::forget(unsigned count)
{
    _changes.clear();
    _boxCount = 0;
    _knownFrom = count;
}

std::optional<std::vector<Box3i>> ChangeLog::since(unsigned count, const Box3i& within) const
{
    if (count < _knownFrom) return std::nullopt;
    std::vector<Box3i> boxes;
    for (auto change = _changes.rbegin(); change != _changes.rend() && change->count > count;
         ++change) {
        const std::vector<Box3i> parts = clipped(change->boxes, within);
        boxes.insert(boxes.end(), parts.begin(), parts.end());
    }
    return coveringBoxes(boxes);
}

} // namespace core
} // namespace osgVolumizer
