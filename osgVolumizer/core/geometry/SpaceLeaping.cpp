#include "SpaceLeaping.h"

#include "Solids.h"

#include <algorithm>
#include <string>

namespace osgVolumizer {
namespace core {

Status SpaceLeaper::setRanges(const glm::ivec3& cells, std::vector<CellRange> ranges)
{
    const double count = double(cells.x) * cells.y * cells.z;
    if (cells.x < 1 || cells.y < 1 || cells.z < 1)
        return {ErrorCode::VALUE_INVALID, "SpaceLeaper: " + std::to_string(cells.x) + " x " +
                                              std::to_string(cells.y) + " x " +
                                              std::to_string(cells.z) + " cells."};
    if (count > 2147483648.0)
        return {ErrorCode::TOO_LARGE,
                "SpaceLeaper: " + std::to_string(count) + " cells are more than 2^31."};
    if (static_cast<double>(ranges.size()) != count)
        return {ErrorCode::SIZE_MISMATCH, "SpaceLeaper: " + std::to_string(ranges.size()) +
                                              " ranges for " + std::to_string(count) + " cells."};
    for (std::size_t i = 0; i < ranges.size(); ++i)
        if (!(ranges[i].minimum <= ranges[i].maximum))
            return {ErrorCode::VALUE_INVALID,
                    "SpaceLeaper: cell " + std::to_string(i) + " has the range " +
                        std::to_string(ranges[i].minimum) + " to " +
                        std::to_string(ranges[i].maximum) + ".",
                    static_cast<std::int64_t>(i)};
    _cells = cells;
    for (int a = 0; a < 3; ++a)
        _regions[a] = (cells[a] + REGION - 1) / REGION;
    _ranges = std::move(ranges);
    _occupied.assign(_ranges.size(), 0);
    _regionBoxes.assign(static_cast<std::size_t>(_regions.x) *
                            static_cast<std::size_t>(_regions.y) *
                            static_cast<std::size_t>(_regions.z),
                        {});
    _boxes.clear();
    _occupiedCells = 0;
    return {};
}

Box3i SpaceLeaper::regionCells(std::size_t region) const
{
    const auto r = static_cast<int>(region);
    const glm::ivec3 at(r % _regions.x, r / _regions.x % _regions.y, r / _regions.x / _regions.y);
    Box3i box;
    for (int a = 0; a < 3; ++a) {
        box.min[a] = at[a] * REGION;
        box.max[a] = std::min(_cells[a], box.min[a] + REGION);
    }
    return box;
}

void SpaceLeaper::mergeRegion(std::size_t region)
{
    std::vector<Box3i>& boxes = _regionBoxes[region];
    boxes.clear();
    const Box3i cells = regionCells(region);
    const glm::ivec3 n = cells.size();
    _left.resize(std::size_t(REGION) * REGION * REGION);
    const auto left = [&](int x, int y, int z) -> std::uint8_t& {
        return _left[static_cast<std::size_t>((z * REGION + y) * REGION + x)];
    };
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; ++x)
                left(x, y, z) = _occupied[index(cells.min + glm::ivec3(x, y, z))];
    const auto allLeft = [&](int x0, int x1, int y0, int y1, int z) {
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x)
                if (!left(x, y, z)) return false;
        return true;
    };
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; ++x) {
                if (!left(x, y, z)) continue;
                glm::ivec3 end(x + 1, y + 1, z + 1);
                while (end.x < n.x && left(end.x, y, z))
                    ++end.x;
                while (end.y < n.y && allLeft(x, end.x, end.y, end.y + 1, z))
                    ++end.y;
                while (end.z < n.z && allLeft(x, end.x, y, end.y, end.z))
                    ++end.z;
                for (int k = z; k < end.z; ++k)
                    for (int j = y; j < end.y; ++j)
                        for (int i = x; i < end.x; ++i)
                            left(i, j, k) = 0;
                Box3i box;
                box.min = cells.min + glm::ivec3(x, y, z);
                box.max = cells.min + end;
                boxes.push_back(box);
            }
}

bool SpaceLeaper::update(const std::function<bool(float, float)>& opaque)
{
    _regionsMerged = 0;
    for (std::size_t r = 0; r < _regionBoxes.size(); ++r) {
        const Box3i cells = regionCells(r);
        bool changed = false;
        for (int z = cells.min.z; z < cells.max.z; ++z)
            for (int y = cells.min.y; y < cells.max.y; ++y)
                for (int x = cells.min.x; x < cells.max.x; ++x) {
                    const std::size_t i = index({x, y, z});
                    const std::uint8_t now = opaque(_ranges[i].minimum, _ranges[i].maximum) ? 1 : 0;
                    changed = changed || now != _occupied[i];
                    _occupiedCells += int(now) - int(_occupied[i]);
                    _occupied[i] = now;
                }
        if (!changed) continue;
        mergeRegion(r);
        ++_regionsMerged;
    }
    if (_regionsMerged == 0) return false;
    _boxes.clear();
    for (const std::vector<Box3i>& boxes : _regionBoxes)
        _boxes.insert(_boxes.end(), boxes.begin(), boxes.end());
    return true;
}

std::vector<Box3d> SpaceLeaper::voxelBoxes(const glm::ivec3& cellSize, const Box3d& extent) const
{
    std::vector<Box3d> r;
    r.reserve(_boxes.size());
    for (const Box3i& b : _boxes) {
        const Box3d cut =
            intersection({glm::dvec3(b.min * cellSize), glm::dvec3(b.max * cellSize)}, extent);
        if (cut.min.x < cut.max.x && cut.min.y < cut.max.y && cut.min.z < cut.max.z)
            r.push_back(cut);
    }
    return r;
}

TetraSet SpaceLeaper::tetraSet(const glm::ivec3& cellSize, const Box3d& extent) const
{
    TetraSet set;
    for (const Box3d& box : voxelBoxes(cellSize, extent)) {
        const TetraSet one = *tessellateBox(box, BoxTessellation::FIVE);
        const auto first = static_cast<TetraSet::Index>(set.vertices.size());
        for (const TetraSet::Index i : one.indices)
            set.indices.push_back(first + i);
        set.vertices.values().insert(set.vertices.values().end(), one.vertices.values().begin(),
                                     one.vertices.values().end());
    }
    return set;
}

} // namespace core
} // namespace osgVolumizer
