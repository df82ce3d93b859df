#include "GridGeometry.h"

#include "GridCells.h"

#include <osgVolumizer/core/geometry/TetraMesh.h>

#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace vtk {

namespace {

// What no cell uses, or only cells that are left out, is often some mark of missing values.
void forgetUnused(const std::vector<core::TetraSet::Index>& indices, std::vector<float>& scalars)
{
    std::vector<bool> used(scalars.size(), false);
    for (const core::TetraSet::Index i : indices)
        used[i] = true;
    for (std::size_t i = 0; i < scalars.size(); ++i)
        if (!used[i]) scalars[i] = std::numeric_limits<float>::quiet_NaN();
}

} // namespace

Result<GridGeometry> convertGrid(vtkUnstructuredGrid& grid, const std::string& arrayName,
                                 std::optional<int> channel)
{
    constexpr vtkIdType MOST = vtkIdType(1) << 31;
    if (grid.GetNumberOfPoints() > MOST)
        return Status(ErrorCode::TOO_LARGE,
                      "there are " + std::to_string(grid.GetNumberOfPoints()) + " points");
    const Result<GridValues> values = GridValues::of(grid, arrayName, channel);
    if (!values.ok()) return values.status;
    GridVertices vertices(grid, *values);
    GridCells cells(grid, *values, vertices);
    if (const Status status = cells.cut(); !status) return status;
    GridGeometry geometry;
    geometry.leftOut = cells.leftOut();
    geometry.name = values->name();
    geometry.notice = values->notice();
    geometry.perTetrahedron = values->ofCells();
    core::TetraSet& set = geometry.tetras;
    set.indices = cells.takeIndices();
    if (set.indices.empty()) {
        const std::string left = geometry.leftOut.text();
        return Status(ErrorCode::VALUE_INVALID,
                      "there are no cells to show" + (left.empty() ? "" : ", but " + left));
    }
    geometry.scalars = values->ofCells() ? cells.takeScalars() : vertices.takeScalars();
    if (!values->ofCells() && !values->isColor()) forgetUnused(set.indices, geometry.scalars);
    set.vertices = vertices.takeVertices();
    if (const Status status = set.validate(); !status) return status;
    // Two samples across a tetrahedron of mean volume, and no more than 1000 along the whole.
    const glm::dvec3 size = set.bounds().size();
    const double diagonal = std::sqrt(size.x * size.x + size.y * size.y + size.z * size.z);
    geometry.spacing =
        std::max(0.5 * std::cbrt(6.0 * core::volume(set) / static_cast<double>(set.tetraCount())),
                 diagonal / 1000.0);
    if (!(geometry.spacing > 0.0) || !std::isfinite(geometry.spacing))
        return Status(ErrorCode::VALUE_INVALID, "the cells have no volume");
    return geometry;
}

} // namespace vtk
} // namespace osgVolumizer
