#include "BoxIndex.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace osgVolumizer {
namespace core {

Status BoxIndex::build(const std::vector<Box3d>& boxes)
{
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box3d& b = boxes[i];
        bool good = !b.empty();
        for (int a = 0; a < 3; ++a)
            good = good && std::isfinite(b.min[a]) && std::isfinite(b.max[a]);
        if (!good)
            return {ErrorCode::VALUE_INVALID,
                    "Clip box " + std::to_string(i) + " is empty or not finite.",
                    static_cast<std::int64_t>(i)};
    }
    _boxes = boxes;
    _nodes.clear();
    if (buildLattice()) return {};
    _cells.clear();
    _order.resize(boxes.size());
    std::iota(_order.begin(), _order.end(), 0u);
    if (!boxes.empty()) buildTree(0, static_cast<std::uint32_t>(boxes.size()));
    return {};
}

std::uint32_t BoxIndex::buildTree(std::uint32_t begin, std::uint32_t end)
{
    const auto index = static_cast<std::uint32_t>(_nodes.size());
    Node node;
    node.begin = begin;
    node.end = end;
    for (std::uint32_t i = begin; i < end; ++i) {
        node.bounds.expand(_boxes[_order[i]].min);
        node.bounds.expand(_boxes[_order[i]].max);
    }
    _nodes.push_back(node);
    if (end - begin <= 4) return index;
    const glm::dvec3 size = node.bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(_order.begin() + begin, _order.begin() + middle, _order.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double ca = _boxes[a].center()[axis], cb = _boxes[b].center()[axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    const std::uint32_t left = buildTree(begin, middle);
    const std::uint32_t right = buildTree(middle, end);
    _nodes[index].left = left;
    _nodes[index].right = right;
    return index;
}

bool BoxIndex::buildLattice()
{
    std::size_t cells = 1;
    for (int a = 0; a < 3; ++a) {
        std::vector<double>& s = _splits[a];
        s.clear();
        for (const Box3d& b : _boxes) {
            if (!(b.min[a] < b.max[a])) return false;
            s.push_back(b.min[a]);
            s.push_back(b.max[a]);
        }
        std::sort(s.begin(), s.end());
        s.erase(std::unique(s.begin(), s.end()), s.end());
        if (s.size() < 2) return false;
        cells *= s.size() - 1;
        // A few boxes far apart are no lattice: keep the memory in proportion.
        if (cells > 64 * _boxes.size() + 4096) return false;
    }
    _cells.assign(cells, -1);
    for (std::size_t i = 0; i < _boxes.size(); ++i) {
        std::size_t cell[3];
        for (int a = 0; a < 3; ++a) {
            const auto low =
                std::lower_bound(_splits[a].begin(), _splits[a].end(), _boxes[i].min[a]);
            if (*(low + 1) != _boxes[i].max[a]) return false;
            cell[a] = static_cast<std::size_t>(low - _splits[a].begin());
        }
        const std::size_t nx = _splits[0].size() - 1, ny = _splits[1].size() - 1;
        int& c = _cells[(cell[2] * ny + cell[1]) * nx + cell[0]];
        if (c >= 0) return false; // twice the same box
        c = static_cast<int>(i);
    }
    return true;
}

bool BoxIndex::cellRange(const std::vector<double>& splits, double min, double max, int& first,
                         int& last)
{
    const int cells = static_cast<int>(splits.size()) - 1;
    const auto above = std::upper_bound(splits.begin(), splits.end(), min);
    first = std::max(0, static_cast<int>(above - splits.begin()) - 1);
    if (first >= cells || max < splits.front()) return false;
    if (!(max > splits.front()) && min < splits.front()) return false;
    const auto end = std::lower_bound(splits.begin(), splits.end(), max);
    last = std::min(cells - 1, std::max(first, static_cast<int>(end - splits.begin()) - 1));
    return true;
}

} // namespace core
} // namespace osgVolumizer
