#include "Lattice.h"

#include "../Text.h"
#include "Orientation.h"
#include "Solids.h"

#include <glm/common.hpp>

#include <array>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

using Index = TetraSet::Index;

Status latticeRefusal(const std::string& text, std::int64_t index = -1)
{
    return {ErrorCode::VALUE_INVALID, "a lattice: " + text, index};
}

// The Bernstein polynomials of degree n - 1 at u, by de Casteljau's recurrence.
std::vector<double> bernstein(int n, double u)
{
    std::vector<double> b(static_cast<std::size_t>(n), 0.0);
    b[0] = 1.0;
    for (std::size_t degree = 1; degree < b.size(); ++degree)
        for (std::size_t i = degree + 1; i-- > 0;)
            b[i] = (1.0 - u) * b[i] + (i > 0 ? u * b[i - 1] : 0.0);
    return b;
}

glm::dvec3 offsetAt(const Lattice& lattice, const std::vector<double>& x,
                    const std::vector<double>& y, const std::vector<double>& z)
{
    glm::dvec3 sum(0.0);
    const glm::dvec3* offset = lattice.offsets.data();
    for (const double wz : z)
        for (const double wy : y)
            for (const double wx : x)
                sum += wx * wy * wz * *offset++;
    return sum;
}

// Corners of the hexahedra of a grid, ring by ring.
std::vector<Index> hexahedra(const glm::ivec3& cells)
{
    const glm::ivec3 n = cells + 1;
    const auto at = [&n](int x, int y, int z) {
        return static_cast<Index>((z * n.y + y) * n.x + x);
    };
    std::vector<Index> indices;
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
                for (const int up : {0, 1})
                    for (const Index i : {at(x, y, z + up), at(x + 1, y, z + up),
                                          at(x + 1, y + 1, z + up), at(x, y + 1, z + up)})
                        indices.push_back(i);
    return indices;
}

// The number of the first tetrahedron that is not the way round that it is at rest; -1 without one.
std::int64_t firstFold(const TetraSet& set, const std::vector<glm::dvec3>& rest)
{
    for (std::size_t t = 0; t < set.tetraCount(); ++t) {
        const Index* i = set.indices.data() + 4 * t;
        const VertexArray& v = set.vertices;
        const int before = orientationSign(rest[i[0]], rest[i[1]], rest[i[2]], rest[i[3]]);
        const int now =
            orientationSign(v.position(i[0]), v.position(i[1]), v.position(i[2]), v.position(i[3]));
        if (before != now) return static_cast<std::int64_t>(t);
    }
    return -1;
}

} // namespace

std::size_t Lattice::count() const
{
    return static_cast<std::size_t>(points.x) * static_cast<std::size_t>(points.y) *
           static_cast<std::size_t>(points.z);
}

glm::dvec3 Lattice::restPoint(std::size_t number) const
{
    const auto nx = static_cast<std::size_t>(points.x), ny = static_cast<std::size_t>(points.y);
    const glm::dvec3 place(number % nx, number / nx % ny, number / nx / ny);
    return glm::mix(box.min, box.max, place / glm::dvec3(points - 1));
}

Status Lattice::validate() const
{
    const glm::dvec3 size = box.size();
    const bool large = size.x > 0.0 && size.y > 0.0 && size.z > 0.0;
    if (!large || !std::isfinite(size.x + size.y + size.z))
        return latticeRefusal("its box has no volume, or is not finite");
    for (int axis = 0; axis < 3; ++axis)
        if (points[axis] < FEWEST_POINTS || points[axis] > MOST_POINTS)
            return latticeRefusal("it has " + formatTriple(points) + " points, expected " +
                                  std::to_string(FEWEST_POINTS) + " to " +
                                  std::to_string(MOST_POINTS) + " along each axis");
    if (!offsets.empty() && offsets.size() != count())
        return {ErrorCode::SIZE_MISMATCH, "a lattice: " + std::to_string(offsets.size()) +
                                              " points are given, expected " +
                                              std::to_string(count())};
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        const glm::dvec3 p = glm::abs(restPoint(i) + offsets[i]);
        if (!(p.x <= TetraSet::MAX_MAGNITUDE && p.y <= TetraSet::MAX_MAGNITUDE &&
              p.z <= TetraSet::MAX_MAGNITUDE))
            return latticeRefusal("point " + std::to_string(i) + " is not finite, or too far away",
                                  static_cast<std::int64_t>(i));
    }
    return {};
}

Result<TetraSet> Lattice::tessellate(const glm::ivec3& cells, const glm::dvec3& origin,
                                     const glm::dvec3& spacing) const
{
    if (Status status = validate(); !status) return status;
    for (int axis = 0; axis < 3; ++axis)
        if (cells[axis] < 1 || cells[axis] > MOST_CELLS)
            return latticeRefusal("it is to have " + formatTriple(cells) +
                                  " cells, expected 1 to " + std::to_string(MOST_CELLS) +
                                  " along each axis");
    std::array<std::vector<std::vector<double>>, 3> weights; // of the control points: axis, place
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i <= cells[axis]; ++i)
            weights[static_cast<std::size_t>(axis)].push_back(
                bernstein(points[axis], static_cast<double>(i) / cells[axis]));
    CellSet set;
    set.kind = CellKind::HEXA;
    set.vertices = VertexArray(VertexFormat(VertexLayout::T3F_V3F));
    std::vector<glm::dvec3> rest;
    for (int z = 0; z <= cells.z; ++z)
        for (int y = 0; y <= cells.y; ++y)
            for (int x = 0; x <= cells.x; ++x)
                rest.push_back(glm::mix(box.min, box.max, glm::dvec3(x, y, z) / glm::dvec3(cells)));
    set.vertices.resize(rest.size());
    std::size_t i = 0;
    for (const std::vector<double>& wz : weights[2])
        for (const std::vector<double>& wy : weights[1])
            for (const std::vector<double>& wx : weights[0]) {
                set.vertices.setVoxelCoordinate(i, (rest[i] - origin) / spacing);
                set.vertices.setPosition(
                    i, offsets.empty() ? rest[i] : rest[i] + offsetAt(*this, wx, wy, wz));
                ++i;
            }
    set.indices = hexahedra(cells);
    Result<TetraSet> bent = set.tessellate();
    if (!bent.ok()) return bent;
    if (const std::int64_t fold = firstFold(*bent, rest); fold >= 0)
        return latticeRefusal("it folds over, and would turn tetrahedra inside out", fold);
    return bent;
}

} // namespace core
} // namespace osgVolumizer
