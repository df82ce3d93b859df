#include "CellLattice.h"

#include <vtkCell.h>

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace vtk {

namespace {

using core::CellKind;

constexpr double TOLERANCE = 1e-6; ///< of parametric coordinates

// Nodes of a cell by their place among the steps along its axes.
class Steps
{
public:
    Steps(CellShape shape, vtkCell& cell) : _shape(shape), _cell(cell)
    {
        const double* p = cell.GetParametricCoords();
        const auto count = static_cast<int>(cell.GetNumberOfPoints());
        for (int axis = 0; axis < 3 && p; ++axis)
            _degrees[axis] = nodesAlong(axis, p, count) - 1;
        if (!valid()) return;
        const glm::ivec3 size = _degrees + 1;
        _nodes.assign(static_cast<std::size_t>(size.x * size.y * size.z), NONE);
        for (int n = 0; n < count; ++n, p += 3)
            place(n, p);
    }
    bool valid() const { return std::min({_degrees.x, _degrees.y, _degrees.z}) >= 1; }
    const glm::ivec3& degrees() const { return _degrees; }
    /// Whether there is such a place in the shape.
    bool within(const glm::ivec3& at) const
    {
        if (_shape == CellShape::TETRA) return at.x + at.y + at.z <= _degrees.x;
        return _shape != CellShape::WEDGE || at.x + at.y <= _degrees.x;
    }
    int& node(const glm::ivec3& at)
    {
        return _nodes[static_cast<std::size_t>(at.x + (_degrees.x + 1) *
                                                          (at.y + (_degrees.y + 1) * at.z))];
    }
    bool addMissing(std::vector<CellLattice::Extra>& extras);

    static constexpr int NONE = -1;

private:
    // That lie on the axis.
    static int nodesAlong(int axis, const double* p, int count)
    {
        int nodes = 0;
        for (int n = 0; n < count; ++n, p += 3)
            nodes += std::abs(p[(axis + 1) % 3]) + std::abs(p[(axis + 2) % 3]) < TOLERANCE;
        return nodes;
    }
    void place(int n, const double* p)
    {
        glm::ivec3 at;
        for (int axis = 0; axis < 3; ++axis) {
            const double step = p[axis] * _degrees[axis];
            at[axis] = static_cast<int>(std::lround(step));
            if (std::abs(step - at[axis]) > TOLERANCE || at[axis] < 0 || at[axis] > _degrees[axis])
                return; // in the middle of a triangle
        }
        if (within(at)) node(at) = n;
    }
    bool cornersAround(const glm::ivec3& at, std::array<int, 4>& corners);

    CellShape _shape;
    vtkCell& _cell;
    glm::ivec3 _degrees{0};
    std::vector<int> _nodes;
};

// Of the quadrilateral that a place lies in, or -1 where it lies within the cell; false where it
// lies elsewhere.
bool Steps::cornersAround(const glm::ivec3& at, std::array<int, 4>& corners)
{
    corners.fill(NONE);
    std::vector<glm::ivec3> around;
    for (int i = 0; i < 8; ++i) {
        glm::ivec3 corner = glm::ivec3(i & 1, i >> 1 & 1, i >> 2) * _degrees;
        if (!within(corner)) continue;
        // Those of a face have what its places have in common.
        bool same = true;
        for (int axis = 0; axis < 3; ++axis)
            same =
                same && ((at[axis] != 0 && at[axis] != _degrees[axis]) || at[axis] == corner[axis]);
        const bool slanted = _shape == CellShape::WEDGE && at.x + at.y == _degrees.x;
        if (same && (!slanted || corner.x + corner.y == _degrees.x)) around.push_back(corner);
    }
    const bool face = around.size() == 4;
    for (std::size_t i = 0; face && i < 4; ++i)
        corners[i] = node(around[i]);
    return face || around.size() == (_shape == CellShape::WEDGE ? 6u : 8u);
}

bool Steps::addMissing(std::vector<CellLattice::Extra>& extras)
{
    const auto count = static_cast<int>(_cell.GetNumberOfPoints());
    std::vector<double> weights(static_cast<std::size_t>(count));
    glm::ivec3 at;
    for (at.z = 0; at.z <= _degrees.z; ++at.z)
        for (at.y = 0; at.y <= _degrees.y; ++at.y)
            for (at.x = 0; at.x <= _degrees.x; ++at.x) {
                if (!within(at) || node(at) != NONE) continue;
                CellLattice::Extra extra;
                if (!cornersAround(at, extra.corners)) return false;
                const glm::dvec3 place = glm::dvec3(at) / glm::dvec3(_degrees);
                _cell.InterpolateFunctions(&place.x, weights.data());
                for (int n = 0; n < count; ++n)
                    if (std::abs(weights[static_cast<std::size_t>(n)]) > 1e-12)
                        extra.weights.emplace_back(n, weights[static_cast<std::size_t>(n)]);
                node(at) = count + static_cast<int>(extras.size());
                extras.push_back(std::move(extra));
            }
    return true;
}

// Adds parts by places relative to one.
class Parts
{
public:
    Parts(Steps& steps, std::vector<CellLattice::Part>& parts) : _steps(steps), _parts(parts) {}
    void add(CellKind kind, const glm::ivec3& at, std::initializer_list<glm::ivec3> corners)
    {
        CellLattice::Part part{kind, {}};
        int n = 0;
        for (const glm::ivec3& corner : corners)
            part.nodes[static_cast<std::size_t>(n++)] = _steps.node(at + corner);
        _parts.push_back(part);
    }

private:
    Steps& _steps;
    std::vector<CellLattice::Part>& _parts;
};

const glm::ivec3 O(0), X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);

void cutTetra(const glm::ivec3& at, int degree, Parts& parts)
{
    const int left = degree - at.x - at.y - at.z;
    if (left >= 1) parts.add(CellKind::TETRA, at, {O, X, Y, Z});
    if (left >= 2) // an octahedron about its diagonal from X to Y + Z
        for (const auto& [a, b] :
             {std::pair(Y, X + Y), std::pair(X + Y, X + Z), std::pair(X + Z, Z), std::pair(Z, Y)})
            parts.add(CellKind::TETRA, at, {X, Y + Z, a, b});
    if (left >= 3) parts.add(CellKind::TETRA, at, {X + Y, X + Z, Y + Z, X + Y + Z});
}

void cutWedge(const glm::ivec3& at, int degree, Parts& parts)
{
    const int left = degree - at.x - at.y;
    if (left >= 1) parts.add(CellKind::PRISM, at, {O, X, Y, Z, X + Z, Y + Z});
    if (left >= 2) parts.add(CellKind::PRISM, at, {X, X + Y, Y, X + Z, X + Y + Z, Y + Z});
}

void cutHexa(const glm::ivec3& at, Parts& parts)
{
    parts.add(CellKind::HEXA, at, {O, X, X + Y, Y, Z, X + Z, X + Y + Z, Y + Z});
}

std::optional<CellLattice> makeSteps(CellShape shape, vtkCell& cell)
{
    CellLattice lattice;
    Steps steps(shape, cell);
    if (!steps.valid() || !steps.addMissing(lattice.extras)) return {};
    Parts parts(steps, lattice.parts);
    const glm::ivec3 degrees = steps.degrees();
    glm::ivec3 at;
    for (at.z = 0; at.z < degrees.z; ++at.z)
        for (at.y = 0; at.y < degrees.y; ++at.y)
            for (at.x = 0; at.x < degrees.x; ++at.x)
                shape == CellShape::TETRA   ? cutTetra(at, degrees.x, parts)
                : shape == CellShape::WEDGE ? cutWedge(at, degrees.x, parts)
                                            : cutHexa(at, parts);
    return lattice;
}

// Quadratic: four pyramids at the base, two above each other in the middle, and tetrahedra between.
std::optional<CellLattice> makePyramid(vtkCell& cell)
{
    CellLattice lattice;
    const vtkIdType count = cell.GetNumberOfPoints();
    if (count == 5) {
        lattice.parts.push_back({CellKind::PYRAMID, {0, 1, 2, 3, 4}});
        return lattice;
    }
    if (count != 13 && count != 19) return {};
    constexpr int MIDDLE = 13; // of the base
    if (count == MIDDLE) {
        CellLattice::Extra middle{{}, {0, 1, 2, 3}};
        for (int i = 0; i < 4; ++i) {
            middle.weights.emplace_back(i, -0.25);
            middle.weights.emplace_back(5 + i, 0.5);
        }
        lattice.extras.push_back(middle);
    }
    for (int i = 0; i < 4; ++i) { // a corner; the middles of edges after, before and above it
        const int after = 5 + i, before = 5 + (i + 3) % 4, above = 9 + i, next = 9 + (i + 1) % 4;
        lattice.parts.push_back({CellKind::PYRAMID, {i, after, MIDDLE, before, above}});
        lattice.parts.push_back({CellKind::TETRA, {after, above, next, MIDDLE}});
    }
    lattice.parts.push_back({CellKind::PYRAMID, {9, 10, 11, 12, 4}});
    lattice.parts.push_back({CellKind::PYRAMID, {9, 12, 11, 10, MIDDLE}});
    return lattice;
}

} // namespace

std::optional<CellLattice> makeLattice(CellShape shape, vtkCell& cell)
{
    return shape == CellShape::PYRAMID ? makePyramid(cell) : makeSteps(shape, cell);
}

} // namespace vtk
} // namespace osgVolumizer
