#include "TetraCrossings.h"

#include "Orientation.h"
#include "TetraMesh.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double WEIGHT_SLACK = 1e-12;
constexpr std::uint32_t CROSSING_LEAF_SIZE = 4;

// The part of [begin, end] where a linear function, a at 0 and b at 1, is not below -slack.
bool keepPositive(double a, double b, double slack, double& begin, double& end)
{
    const double rate = b - a, low = a + slack;
    if (rate > 0.0)
        begin = std::max(begin, -low / rate);
    else if (rate < 0.0)
        end = std::min(end, -low / rate);
    else if (!(low >= 0.0))
        return false;
    return begin <= end;
}

Box3d boundsOf(const TetraSet& set, std::size_t tetrahedron)
{
    Box3d box;
    for (std::size_t i = 0; i < 4; ++i)
        box.expand(set.vertices.position(set.indices[4 * tetrahedron + i]));
    return box;
}

} // namespace

bool cutSegment(const Plane& plane, const glm::dvec3& start, const glm::dvec3& end,
                double& beginParameter, double& endParameter)
{
    return keepPositive(plane.distance(start), plane.distance(end), 0.0, beginParameter,
                        endParameter);
}

bool cutSegment(const Box3d& box, const glm::dvec3& start, const glm::dvec3& end,
                double& beginParameter, double& endParameter)
{
    for (int a = 0; a < 3; ++a)
        if (!keepPositive(start[a] - box.min[a], end[a] - box.min[a], 0.0, beginParameter,
                          endParameter) ||
            !keepPositive(box.max[a] - start[a], box.max[a] - end[a], 0.0, beginParameter,
                          endParameter))
            return false;
    return true;
}

TetraCrossings::TetraCrossings(std::shared_ptr<const TetraSet> set) : _set(std::move(set))
{
    const std::size_t count = _set->tetraCount();
    if (count == 0) return;
    std::vector<Box3d> boxes(count);
    for (std::size_t t = 0; t < count; ++t)
        boxes[t] = boundsOf(*_set, t);
    _order.resize(count);
    std::iota(_order.begin(), _order.end(), 0u);
    build(boxes, 0, static_cast<std::uint32_t>(count));
}

std::uint32_t TetraCrossings::build(const std::vector<Box3d>& boxes, std::uint32_t begin,
                                    std::uint32_t end)
{
    const auto number = static_cast<std::uint32_t>(_nodes.size());
    Node node;
    node.begin = begin;
    node.end = end;
    for (std::uint32_t i = begin; i < end; ++i) {
        node.bounds.expand(boxes[_order[i]].min);
        node.bounds.expand(boxes[_order[i]].max);
    }
    _nodes.push_back(node);
    if (end - begin <= CROSSING_LEAF_SIZE) return number;
    const glm::dvec3 size = node.bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto first = _order.begin();
    std::nth_element(first + begin, first + middle, first + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double p = boxes[a].center()[axis], q = boxes[b].center()[axis];
                         return p != q ? p < q : a < b;
                     });
    const std::uint32_t left = build(boxes, begin, middle), right = build(boxes, middle, end);
    _nodes[number].left = left;
    _nodes[number].right = right;
    return number;
}

bool TetraCrossings::cross(std::uint32_t tetrahedron, const glm::dvec3& start,
                           const glm::dvec3& end, Crossing& crossing) const
{
    glm::dvec3 p[4];
    for (std::size_t i = 0; i < 4; ++i)
        p[i] = _set->vertices.position(_set->indices[4 * std::size_t(tetrahedron) + i]);
    const glm::dmat3 edges(p[1] - p[0], p[2] - p[0], p[3] - p[0]);
    const glm::dmat3 inverse = glm::inverse(edges);
    const auto weights = [&](const glm::dvec3& q) {
        const glm::dvec3 w = inverse * (q - p[0]);
        return glm::dvec4(1.0 - w.x - w.y - w.z, w);
    };
    const glm::dvec4 a = weights(start), b = weights(end);
    if (!std::isfinite(glm::dot(a, b))) return false;
    crossing = {tetrahedron, 0.0, 1.0, a, b};
    for (int i = 0; i < 4; ++i)
        if (!keepPositive(a[i], b[i], WEIGHT_SLACK, crossing.begin, crossing.end)) return false;
    crossing.beginWeights = a + crossing.begin * (b - a);
    crossing.endWeights = a + crossing.end * (b - a);
    return true;
}

std::vector<TetraCrossings::Crossing> TetraCrossings::find(const glm::dvec3& start,
                                                           const glm::dvec3& end) const
{
    std::vector<Crossing> crossings;
    std::vector<std::uint32_t> open;
    if (!_nodes.empty()) open.push_back(0);
    while (!open.empty()) {
        const Node& node = _nodes[open.back()];
        open.pop_back();
        const glm::dvec3 margin = WEIGHT_SLACK * (glm::abs(node.bounds.min) + node.bounds.size());
        double from = 0.0, to = 1.0;
        if (!cutSegment(Box3d{node.bounds.min - margin, node.bounds.max + margin}, start, end, from,
                        to))
            continue;
        if (node.left != 0) {
            open.push_back(node.left);
            open.push_back(node.right);
            continue;
        }
        Crossing crossing;
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (cross(_order[i], start, end, crossing)) crossings.push_back(crossing);
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.begin != b.begin ? a.begin < b.begin : a.tetrahedron < b.tetrahedron;
    });
    return crossings;
}

namespace {

// On which side of the line through s and e that through p and q passes. Where they meet: on which
// it would if e were moved a little along x, less along y, still less along z (Edelsbrunner and
// Muecke, "Simulation of simplicity", ACM Transactions on Graphics 9, 1990).
int passingSide(const glm::dvec3& s, const glm::dvec3& e, const glm::dvec3& p, const glm::dvec3& q)
{
    int sign = orientationSign(s, e, p, q);
    for (int axis = 0; axis < 3 && sign == 0; ++axis) {
        glm::dvec3 moved = s;
        moved[axis] += std::max(1.0, std::fabs(s[axis]));
        sign = orientationSign(s, moved, p, q);
    }
    return sign;
}

// 1 or -1 where the segment goes through the triangle, 1 from the side that it is seen
// counter-clockwise from; else 0.
int passes(const glm::dvec3& s, const glm::dvec3& e, const glm::dvec3& a, const glm::dvec3& b,
           const glm::dvec3& c)
{
    const int before = orientationSign(a, b, c, s), after = orientationSign(a, b, c, e);
    if ((before > 0) == (after > 0)) return 0;
    const int ab = passingSide(s, e, a, b), bc = passingSide(s, e, b, c),
              ca = passingSide(s, e, c, a);
    if (ab == 0 || ab != bc || bc != ca) return 0;
    return before > 0 ? 1 : -1;
}

// The face opposite of a corner, if the segment goes through it.
void addCrossing(const TetraSet& set, std::size_t tetrahedron, std::size_t corner,
                 const glm::dvec3& start, const glm::dvec3& end,
                 std::vector<BoundaryCrossing>& crossings)
{
    BoundaryCrossing crossing;
    crossing.tetrahedron = static_cast<std::uint32_t>(tetrahedron);
    glm::dvec3 p[3];
    for (std::size_t k = 0; k < 3; ++k) {
        crossing.vertices[k] = set.indices[4 * tetrahedron + (corner + 1 + k) % 4];
        p[k] = set.vertices.position(crossing.vertices[k]);
    }
    const glm::dvec3 inner = set.vertices.position(set.indices[4 * tetrahedron + corner]);
    if (orientationSign(p[0], p[1], p[2], inner) > 0) {
        std::swap(crossing.vertices[1], crossing.vertices[2]);
        std::swap(p[1], p[2]);
    }
    const int way = passes(start, end, p[0], p[1], p[2]);
    if (way == 0) return;
    crossing.enters = way > 0; // from where the face is seen from outside
    const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double from = glm::dot(normal, start - p[0]), to = glm::dot(normal, end - p[0]);
    crossing.parameter = from == to ? 0.0 : std::clamp(from / (from - to), 0.0, 1.0);
    crossings.push_back(crossing);
}

// Where a segment enters and leaves in one place, rounding may have exchanged the two: none leaves
// what it is not in.
void enterFirst(std::vector<BoundaryCrossing>& crossings)
{
    int inside = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        constexpr double SAME = 1e-9;
        std::size_t k = i;
        while (inside == 0 && k + 1 < crossings.size() && !crossings[k].enters &&
               crossings[k + 1].parameter <= crossings[i].parameter + SAME)
            ++k;
        if (k != i && crossings[k].enters) std::swap(crossings[i], crossings[k]);
        inside += crossings[i].enters ? 1 : -1;
        if (inside < 0) inside = 0; // it began inside
    }
}

} // namespace

std::vector<BoundaryCrossing> boundaryCrossings(const TetraSet& set, const glm::dvec3& start,
                                                const glm::dvec3& end)
{
    std::vector<BoundaryCrossing> crossings;
    const Adjacency adjacency = findAdjacency(set);
    for (std::size_t t = 0; t < set.tetraCount(); ++t)
        for (std::size_t i = 0; i < 4; ++i)
            if (adjacency.neighbours[t][i] == Adjacency::NONE)
                addCrossing(set, t, i, start, end, crossings);
    std::stable_sort(crossings.begin(), crossings.end(),
                     [](const BoundaryCrossing& a, const BoundaryCrossing& b) {
                         return a.parameter < b.parameter;
                     });
    enterFirst(crossings);
    return crossings;
}

} // namespace core
} // namespace osgVolumizer
