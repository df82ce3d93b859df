#pragma once

#include "GridValues.h"

#include <osgVolumizer/core/geometry/TetraSet.h>

#include <array>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

class vtkUnstructuredGrid;

namespace osgVolumizer {
namespace vtk {

/// The points of a grid as vertices of tetrahedra, with their scalars or colours, and those that
/// are added where cells are cut. The first have the numbers of their points.
class GridVertices
{
public:
    using Index = core::TetraSet::Index;
    /// A weighted sum of points of the grid. Weights add up to 1.
    using Terms = std::vector<std::pair<Index, double>>;
    /// Corners of a face, in any order.
    using Face = std::array<Index, 4>;

    /// Keeps references. Expects fewer than 2^32 points.
    GridVertices(vtkUnstructuredGrid& grid, const GridValues& values);

    Index add(const Terms& terms);
    /// The vertex within a face: one, from whichever side it is asked for.
    Index addWithin(Face face, const Terms& terms);
    /// Moves a point to where it is seen: control points of Bezier cells lie elsewhere.
    void move(Index point, const Terms& terms) { evaluate(terms, point); }

    std::size_t size() const { return _array.size(); }
    glm::dvec3 position(Index vertex) const { return _array.position(vertex); }
    /// Whether its scalar is, or it has none.
    bool isFinite(Index vertex) const;

    core::VertexArray takeVertices() { return std::move(_array); }
    /// One per vertex, or none.
    std::vector<float> takeScalars() { return std::move(_scalars); }

private:
    struct HashOfFace
    {
        std::size_t operator()(const Face& face) const;
    };
    void evaluate(const Terms& terms, Index into);

    vtkUnstructuredGrid& _grid;
    const GridValues& _values;
    core::VertexArray _array;
    std::vector<float> _scalars;
    std::unordered_map<Face, Index, HashOfFace> _faces;
};

} // namespace vtk
} // namespace osgVolumizer
