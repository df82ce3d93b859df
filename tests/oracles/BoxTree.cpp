#include "BoxTree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgVolumizer {
namespace oracle {
namespace {

constexpr std::uint32_t LEAF_SIZE = 4;

// Grown by far more than distances along a line are rounded by.
core::Box3d padded(core::Box3d box)
{
    double magnitude = 0.0;
    for (int a = 0; a < 3; ++a)
        magnitude = std::max({magnitude, std::abs(box.min[a]), std::abs(box.max[a])});
    box.min -= glm::dvec3(1e-12 * magnitude);
    box.max += glm::dvec3(1e-12 * magnitude);
    return box;
}

bool meets(const core::Box3d& box, const glm::dvec3& origin, const glm::dvec3& direction, double t0,
           double t1)
{
    for (int a = 0; a < 3; ++a) {
        if (direction[a] == 0.0) {
            if (origin[a] < box.min[a] || origin[a] > box.max[a]) return false;
            continue;
        }
        const double low = (box.min[a] - origin[a]) / direction[a];
        const double high = (box.max[a] - origin[a]) / direction[a];
        t0 = std::max(t0, std::min(low, high));
        t1 = std::min(t1, std::max(low, high));
    }
    return t0 <= t1;
}

} // namespace

BoxTree::BoxTree(const std::vector<core::Box3d>& boxes) : _order(boxes.size())
{
    std::iota(_order.begin(), _order.end(), 0u);
    if (boxes.empty()) return;
    _nodes.reserve(boxes.size());
    _nodes.emplace_back();
    build(boxes, 0, 0, std::uint32_t(boxes.size()));
}

void BoxTree::build(const std::vector<core::Box3d>& boxes, std::size_t node, std::uint32_t first,
                    std::uint32_t count)
{
    core::Box3d all, centers;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const core::Box3d& box = boxes[_order[i]];
        all.expand(box.min);
        all.expand(box.max);
        centers.expand(box.center());
    }
    _nodes[node].box = padded(all);
    if (count <= LEAF_SIZE) {
        _nodes[node].first = first;
        _nodes[node].count = count;
        return;
    }
    const glm::dvec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t half = count / 2;
    const auto begin = _order.begin() + std::ptrdiff_t(first);
    std::nth_element(begin, begin + std::ptrdiff_t(half), begin + std::ptrdiff_t(count),
                     [&](std::uint32_t a, std::uint32_t b) {
                         return boxes[a].center()[axis] < boxes[b].center()[axis];
                     });
    const std::size_t children = _nodes.size();
    _nodes.resize(children + 2);
    _nodes[node].first = std::uint32_t(children);
    build(boxes, children, first, half);
    build(boxes, children + 1, first + half, count - half);
}

void BoxTree::appendMet(const glm::dvec3& origin, const glm::dvec3& direction, double t0, double t1,
                        std::vector<std::uint32_t>& numbers) const
{
    if (_nodes.empty()) return;
    std::vector<std::uint32_t> pending{0};
    while (!pending.empty()) {
        const Node& node = _nodes[pending.back()];
        pending.pop_back();
        if (!meets(node.box, origin, direction, t0, t1)) continue;
        if (node.count == 0) {
            pending.push_back(node.first);
            pending.push_back(node.first + 1);
            continue;
        }
        const auto begin = _order.begin() + std::ptrdiff_t(node.first);
        numbers.insert(numbers.end(), begin, begin + std::ptrdiff_t(node.count));
    }
}

} // namespace oracle
} // namespace osgVolumizer
