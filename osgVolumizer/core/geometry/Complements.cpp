#include "Solids.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <string>
#include <tuple>

namespace osgVolumizer {
namespace core {

namespace {

using Index = TetraSet::Index;

Status invalid(const char* solid, const char* what, double value)
{
    return {ErrorCode::VALUE_INVALID,
            std::string(solid) + ": " + what + " is " + std::to_string(value) + "."};
}

Status checkHole(const char* solid, const Box3d& box, const glm::dvec3& center, double radius,
                 int axis)
{
    if (!(radius > 0.0) || !std::isfinite(radius)) return invalid(solid, "radius", radius);
    for (int a = 0; a < 3; ++a) {
        if (!(box.min[a] < box.max[a]) || !std::isfinite(box.size()[a]))
            return invalid(solid, "box size", box.size()[a]);
        if (!std::isfinite(center[a])) return invalid(solid, "center", center[a]);
        if (a != axis && !(center[a] - radius > box.min[a] && center[a] + radius < box.max[a]))
            return invalid(solid, "distance of the hole from the box",
                           std::min(center[a] - box.min[a], box.max[a] - center[a]) - radius);
    }
    return {};
}

void setPosition(VertexArray& vertices, Index i, const glm::dvec3& p)
{
    if (vertices.size() <= i) vertices.resize(i + 1);
    vertices.setPosition(i, p);
}

} // namespace

Result<TetraSet> BoxMinusSphere::tessellate() const
{
    if (Status s = checkHole("BoxMinusSphere", box, center, radius, -1); !s) return s;
    if (divisions < 1) return invalid("BoxMinusSphere", "divisions", divisions);
    if (divisions > 512)
        return Status(ErrorCode::TOO_LARGE, "BoxMinusSphere: divisions is " +
                                                std::to_string(divisions) + ", 512 are possible.");
    const int n = divisions;
    CellSet cells;
    cells.kind = CellKind::HEXA;
    // Grid points of the box's surface; each has a partner on the sphere, straight towards the
    // centre.
    std::map<std::tuple<int, int, int>, Index> known;
    const auto point = [&](const glm::ivec3& g) {
        const auto found =
            known.emplace(std::make_tuple(g.x, g.y, g.z), static_cast<Index>(2 * known.size()));
        const Index i = found.first->second;
        if (found.second) {
            const glm::dvec3 outer = box.min + box.size() * (glm::dvec3(g) / double(n));
            setPosition(cells.vertices, i, outer);
            setPosition(cells.vertices, i + 1, center + radius * glm::normalize(outer - center));
        }
        return i;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                    Index ring[4];
                    for (int k = 0; k < 4; ++k) {
                        glm::ivec3 g(0);
                        // Counter-clockwise from outside on the upper side, so that the ring on the
                        // sphere, then that on the box, have positive orientation.
                        const int c = side ? k : 3 - k;
                        g[axis] = side * n;
                        g[u] = i + (c == 1 || c == 2 ? 1 : 0);
                        g[v] = j + (c >= 2 ? 1 : 0);
                        ring[k] = point(g);
                    }
                    for (int inner = 1; inner >= 0; --inner)
                        for (const Index r : ring)
                            cells.indices.push_back(r + Index(inner));
                }
    return cells.tessellate();
}

Result<TetraSet> BoxMinusCylinder::tessellate() const
{
    if (axis < 0 || axis > 2) return invalid("BoxMinusCylinder", "axis", axis);
    if (Status s = checkHole("BoxMinusCylinder", box, center, radius, axis); !s) return s;
    if (divisions < 1) return invalid("BoxMinusCylinder", "divisions", divisions);
    if (stacks < 1) return invalid("BoxMinusCylinder", "stacks", stacks);
    if (24.0 * divisions * stacks > 16777216.0)
        return Status(ErrorCode::TOO_LARGE, "BoxMinusCylinder: divisions times stacks is " +
                                                std::to_string(double(divisions) * stacks) + ".");
    const int n = divisions, around = 4 * n, u = (axis + 1) % 3, v = (axis + 2) % 3;
    CellSet cells;
    cells.kind = CellKind::HEXA;
    for (int s = 0; s <= stacks; ++s)
        for (int i = 0; i < around; ++i) {
            // Counter-clockwise along the rim of the rectangle.
            const int side = i / n;
            const double t = double(i % n) / n;
            const double a = side == 0 ? t : side == 1 ? 1.0 : side == 2 ? 1.0 - t : 0.0;
            const double b = side == 0 ? 0.0 : side == 1 ? t : side == 2 ? 1.0 : 1.0 - t;
            glm::dvec3 outer(0.0);
            outer[axis] = box.min[axis] + box.size()[axis] * (double(s) / stacks);
            outer[u] = box.min[u] + box.size()[u] * a;
            outer[v] = box.min[v] + box.size()[v] * b;
            glm::dvec3 middle = center;
            middle[axis] = outer[axis];
            const Index at = static_cast<Index>(2 * (s * around + i));
            setPosition(cells.vertices, at, outer);
            setPosition(cells.vertices, at + 1, middle + radius * glm::normalize(outer - middle));
        }
    for (int s = 0; s < stacks; ++s)
        for (int i = 0; i < around; ++i)
            for (int layer = 0; layer < 2; ++layer) {
                const auto at = [&](int k, int inner) {
                    return static_cast<Index>(2 * ((s + layer) * around + k % around) + inner);
                };
                cells.indices.insert(cells.indices.end(),
                                     {at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1)});
            }
    return cells.tessellate();
}

} // namespace core
} // namespace osgVolumizer
