#include "TetraMesh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::uint32_t LEAF_SIZE = 8;
constexpr int MAX_DEPTH = 60;
constexpr double TOLERANCE = 1e-12;

Box3d boundsOf(const TetraSet& set, std::uint32_t t)
{
    Box3d box;
    for (std::size_t k = 0; k < 4; ++k)
        box.expand(set.vertices.position(set.indices[4 * t + k]));
    return box;
}

bool holds(const Box3d& box, const glm::dvec3& p)
{
    const glm::dvec3 slack = TOLERANCE * box.size();
    for (int a = 0; a < 3; ++a)
        if (!(p[a] >= box.min[a] - slack[a] && p[a] <= box.max[a] + slack[a])) return false;
    return true;
}

/// Barycentric weights; false where the point is outside or the tetrahedron has no volume.
bool weigh(const TetraSet& set, std::uint32_t t, const glm::dvec3& p, glm::dvec4& weights)
{
    glm::dvec3 v[4];
    for (std::size_t k = 0; k < 4; ++k)
        v[k] = set.vertices.position(set.indices[4 * t + k]);
    const glm::dvec3 a = v[1] - v[0], b = v[2] - v[0], c = v[3] - v[0], q = p - v[0];
    const double six = glm::dot(glm::cross(a, b), c);
    if (six == 0.0) return false;
    weights.y = glm::dot(glm::cross(q, b), c) / six;
    weights.z = glm::dot(glm::cross(a, q), c) / six;
    weights.w = glm::dot(glm::cross(a, b), q) / six;
    weights.x = 1.0 - weights.y - weights.z - weights.w;
    return weights.x >= -TOLERANCE && weights.y >= -TOLERANCE && weights.z >= -TOLERANCE &&
           weights.w >= -TOLERANCE;
}

} // namespace

PointLocator::PointLocator(const TetraSet& set) : _set(set), _order(set.tetraCount())
{
    std::iota(_order.begin(), _order.end(), 0u);
    if (!_order.empty()) build(0, static_cast<std::uint32_t>(_order.size()), 0);
}

std::uint32_t PointLocator::build(std::uint32_t begin, std::uint32_t end, int depth)
{
    const auto index = static_cast<std::uint32_t>(_nodes.size());
    _nodes.emplace_back();
    Box3d bounds;
    for (std::uint32_t i = begin; i < end; ++i) {
        const Box3d b = boundsOf(_set, _order[i]);
        bounds.expand(b.min);
        bounds.expand(b.max);
    }
    _nodes[index].bounds = bounds;
    _nodes[index].begin = begin;
    _nodes[index].end = end;
    if (end - begin <= LEAF_SIZE || depth == MAX_DEPTH) return index;
    const glm::dvec3 size = bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(_order.begin() + begin, _order.begin() + middle, _order.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double ca = boundsOf(_set, a).center()[axis];
                         const double cb = boundsOf(_set, b).center()[axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    const std::uint32_t left = build(begin, middle, depth + 1);
    const std::uint32_t right = build(middle, end, depth + 1);
    _nodes[index].left = left;
    _nodes[index].right = right;
    return index;
}

std::optional<PointLocator::Place> PointLocator::locate(const glm::dvec3& p) const
{
    std::optional<Place> best;
    if (_nodes.empty()) return best;
    std::uint32_t stack[2 * MAX_DEPTH + 4];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Node& node = _nodes[stack[--top]];
        if (!holds(node.bounds, p)) continue;
        if (node.left != 0) {
            stack[top++] = node.right;
            stack[top++] = node.left;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            Place place;
            place.tetrahedron = _order[i];
            if (best && best->tetrahedron < place.tetrahedron) continue;
            if (weigh(_set, place.tetrahedron, p, place.weights)) best = place;
        }
    }
    return best;
}

} // namespace core
} // namespace osgVolumizer
