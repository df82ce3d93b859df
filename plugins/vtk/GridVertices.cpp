#include "GridVertices.h"

#include <vtkUnstructuredGrid.h>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace vtk {

GridVertices::GridVertices(vtkUnstructuredGrid& grid, const GridValues& values)
    : _grid(grid), _values(values),
      _array(values.isColor() ? core::VertexLayout::C4F_V3F : core::VertexLayout::V3F)
{
    const auto count = static_cast<std::size_t>(grid.GetNumberOfPoints());
    _array.resize(count);
    if (!values.isColor() && !values.ofCells()) _scalars.resize(count);
    Terms itself{{0, 1.0}};
    for (std::size_t i = 0; i < count; ++i) {
        itself[0].first = static_cast<Index>(i);
        evaluate(itself, itself[0].first);
    }
}

GridVertices::Index GridVertices::add(const Terms& terms)
{
    const auto vertex = static_cast<Index>(_array.size());
    _array.resize(_array.size() + 1);
    if (!_scalars.empty()) _scalars.push_back(0.0f);
    evaluate(terms, vertex);
    return vertex;
}

GridVertices::Index GridVertices::addWithin(Face face, const Terms& terms)
{
    std::sort(face.begin(), face.end());
    const auto found = _faces.find(face);
    if (found != _faces.end()) return found->second;
    return _faces[face] = add(terms);
}

bool GridVertices::isFinite(Index vertex) const
{
    return _scalars.empty() || std::isfinite(_scalars[vertex]);
}

std::size_t GridVertices::HashOfFace::operator()(const Face& face) const
{
    std::uint64_t hash = 0; // FNV-1a, by words
    for (const Index corner : face)
        hash = (hash ^ corner) * 0x100000001b3u;
    return static_cast<std::size_t>(hash ^ hash >> 32);
}

// From the points, and not from what became of them.
void GridVertices::evaluate(const Terms& terms, Index into)
{
    glm::dvec3 position(0.0);
    double scalar = 0.0, color[4] = {};
    for (const auto& [point, weight] : terms) {
        double p[3];
        _grid.GetPoint(static_cast<vtkIdType>(point), p);
        position += weight * glm::dvec3(p[0], p[1], p[2]);
        if (!_scalars.empty()) scalar += weight * _values.scalar(static_cast<vtkIdType>(point));
        for (int k = 0; k < 4 && _values.isColor(); ++k)
            color[k] += weight * _values.color(static_cast<vtkIdType>(point), k);
    }
    _array.setPosition(into, position);
    if (!_scalars.empty()) _scalars[into] = static_cast<float>(scalar);
    // Weights may be negative.
    for (int k = 0; k < 4 && _values.isColor(); ++k)
        _array.record(into)[_array.format().colorOffset() + k] = glm::clamp(color[k], 0.0, 1.0);
}

} // namespace vtk
} // namespace osgVolumizer
