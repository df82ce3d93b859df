#include "MeshOracle.h"

#include "ForEachPixel.h"
#include "Ray.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace oracle {
namespace {

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Value>
Value valueAt(const std::vector<Value>& values, const TetraMesh::Cell& cell,
              const std::array<double, 4>& weights)
{
    Value sum(0.0);
    for (std::size_t i = 0; i < 4; ++i)
        sum += weights[i] * values[cell[i]];
    return sum;
}

Medium mediumOf(const glm::dvec4& color, double lengthUnits)
{
    const double extinction = lengthUnits * Table::extinction(color.a);
    return {extinction, extinction * glm::dvec3(color)};
}

} // namespace

MeshOracle::MeshOracle(TetraMesh mesh, Table table, double unit, double tolerance)
    : _mesh(std::move(mesh)), _table(std::move(table)), _unit(unit), _tolerance(tolerance)
{
    std::vector<core::Box3d> boxes;
    for (std::size_t c = 0; c < _mesh.cells.size(); ++c) {
        const TetraMesh::Cell& cell = _mesh.cells[c];
        if (!isDrawn(cell, c)) continue;
        core::Box3d box;
        for (std::size_t i = 0; i < 4; ++i)
            box.expand(_mesh.corner(cell, i));
        boxes.push_back(box);
        _drawn.push_back(std::uint32_t(c));
    }
    _tree = BoxTree(boxes);
}

bool MeshOracle::isDrawn(const TetraMesh::Cell& cell, std::size_t number) const
{
    for (std::uint32_t point : cell) {
        if (!isFinite(_mesh.points[point])) return false;
        if (!_mesh.colors.empty()) {
            const glm::dvec4& color = _mesh.colors[point];
            if (!isFinite(glm::dvec3(color)) || !std::isfinite(color.a)) return false;
        } else if (!std::isfinite(_mesh.scalars[_mesh.scalarsPerCell ? number : point])) {
            return false;
        }
    }
    return true;
}

std::vector<MeshSegment> MeshOracle::segments(const glm::dvec3& origin, const glm::dvec3& direction,
                                              double tNear, double tFar) const
{
    std::vector<std::uint32_t> met;
    _tree.appendMet(origin, direction, tNear, tFar, met);
    std::vector<MeshSegment> whole;
    for (std::uint32_t number : met) {
        MeshSegment segment;
        if (crossCell(_mesh, _drawn[number], origin, direction, segment)) whole.push_back(segment);
    }
    std::sort(whole.begin(), whole.end(), [](const MeshSegment& a, const MeshSegment& b) {
        return a.enter != b.enter ? a.enter < b.enter : a.cell < b.cell;
    });
    std::vector<MeshSegment> inSight;
    double reached = tNear;
    for (const MeshSegment& segment : whole) {
        const double enter = std::max(segment.enter, reached);
        const double leave = std::min(segment.leave, tFar);
        if (!(enter < leave)) continue;
        inSight.push_back(partOf(segment, enter, leave));
        reached = leave;
    }
    return inSight;
}

// Where the scalar passes a point of the table, the medium has a kink or a jump: cut there.
void MeshOracle::integrateSegment(const MeshSegment& segment, double length, Light& result) const
{
    const TetraMesh::Cell& cell = _mesh.cells[segment.cell];
    const double units = length / _unit;
    if (!_mesh.colors.empty()) {
        const glm::dvec4 a = valueAt(_mesh.colors, cell, segment.enterWeights);
        const glm::dvec4 b = valueAt(_mesh.colors, cell, segment.leaveWeights);
        integrate([&](double f) { return mediumOf(a + f * (b - a), units); }, 0.0, 1.0, _tolerance,
                  result);
        return;
    }
    const bool constant = _mesh.scalarsPerCell;
    const double a =
        constant ? _mesh.scalars[segment.cell] : valueAt(_mesh.scalars, cell, segment.enterWeights);
    const double b = constant ? a : valueAt(_mesh.scalars, cell, segment.leaveWeights);
    std::vector<double> cuts{0.0, 1.0};
    for (double knot : _table.knots())
        if (std::min(a, b) < knot && knot < std::max(a, b)) cuts.push_back((knot - a) / (b - a));
    std::sort(cuts.begin(), cuts.end());
    const auto medium = [&](double f) { return mediumOf(_table.color(a + f * (b - a)), units); };
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
        integrate(medium, cuts[i], cuts[i + 1], _tolerance, result);
}

glm::dvec4 MeshOracle::light(const glm::dvec3& origin, const glm::dvec3& direction, double tNear,
                             double tFar) const
{
    Light result;
    for (const MeshSegment& segment : segments(origin, direction, tNear, tFar))
        integrateSegment(segment, (segment.leave - segment.enter) * glm::length(direction), result);
    return glm::dvec4(result.color, 1.0 - result.transmittance);
}

glm::dvec4 MeshOracle::light(const Camera& camera, const glm::dmat4& objectToWorld, double x,
                             double y) const
{
    const Ray ray = rayThrough(camera, x, y);
    const glm::dmat4 toObject = glm::inverse(camera.view * objectToWorld);
    return light(glm::dvec3(toObject * glm::dvec4(ray.origin, 1.0)),
                 glm::dvec3(toObject * glm::dvec4(ray.direction, 0.0)), camera.nearDepth,
                 camera.farDepth);
}

support::FloatImage render(const MeshOracle& mesh, const Camera& camera,
                           const glm::dmat4& objectToWorld, int stride)
{
    const auto count = [stride](int pixels) { return (pixels - stride / 2 + stride - 1) / stride; };
    return forEachPixel(count(camera.width), count(camera.height), [&](int x, int y) {
        return mesh.light(camera, objectToWorld, stride * x + stride / 2 + 0.5,
                          stride * y + stride / 2 + 0.5);
    });
}

} // namespace oracle
} // namespace osgVolumizer
