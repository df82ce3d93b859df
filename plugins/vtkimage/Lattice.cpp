#include "Lattice.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkRectilinearGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace vtkimage {

namespace {

Lattice latticeOfImage(vtkImageData& image, bool cells)
{
    int extent[6];
    image.GetExtent(extent);
    const vtkMatrix4x4& matrix = *image.GetIndexToPhysicalMatrix();
    Lattice lattice;
    glm::dvec3 first(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const int points = extent[2 * axis + 1] - extent[2 * axis] + 1;
        const bool middles = cells && points > 1;
        lattice.size[axis] = points - (middles ? 1 : 0);
        first[axis] = extent[2 * axis] + (middles ? 0.5 : 0.0);
        for (int row = 0; row < 3; ++row)
            lattice.steps[axis][row] = matrix.GetElement(row, axis);
        // A flat image's thickness may be missing.
        if (points == 1 && lattice.steps[axis] == glm::dvec3(0.0))
            for (int row = 0; row < 3; ++row)
                lattice.steps[axis][row] = image.GetDirectionMatrix()->GetElement(row, axis);
    }
    lattice.position =
        glm::dvec3(matrix.GetElement(0, 3), matrix.GetElement(1, 3), matrix.GetElement(2, 3)) +
        lattice.steps * first;
    return lattice;
}

// Along an axis; of cells the middles.
Result<std::vector<double>> positionsOf(vtkDataArray* coordinates, int points, bool cells)
{
    if (!coordinates || coordinates->GetNumberOfTuples() != points ||
        coordinates->GetNumberOfComponents() != 1)
        return Status(ErrorCode::VALUE_INVALID, "are not one for each point");
    std::vector<double> x(static_cast<std::size_t>(points));
    double direction = 0.0;
    for (int i = 0; i < points; ++i) {
        x[std::size_t(i)] = coordinates->GetComponent(i, 0);
        if (!std::isfinite(x[std::size_t(i)]))
            return Status(ErrorCode::VALUE_INVALID, "are not finite");
        if (i == 0) continue;
        const double step = x[std::size_t(i)] - x[std::size_t(i - 1)];
        if (step == 0.0 || step * direction < 0.0)
            return Status(ErrorCode::VALUE_INVALID, "do not all rise or all fall");
        direction = step > 0.0 ? 1.0 : -1.0;
    }
    if (!cells || points < 2) return x;
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
        x[i] = 0.5 * (x[i] + x[i + 1]);
    x.pop_back();
    return x;
}

bool isEvenlySpaced(const std::vector<double>& x)
{
    constexpr double TOLERANCE = 1e-4; // of the spacing
    const double step = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
    const double farthest = std::max(std::abs(x.front()), std::abs(x.back()));
    // Coordinates in single precision are as exact as that.
    const double bound = TOLERANCE * std::abs(step) +
                         static_cast<double>(std::numeric_limits<float>::epsilon()) * farthest;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (std::abs(x[i] - (x.front() + static_cast<double>(i) * step)) > bound) return false;
    return true;
}

Result<Lattice> latticeOfGrid(vtkRectilinearGrid& grid, bool cells)
{
    int points[3];
    grid.GetDimensions(points);
    vtkDataArray* const coordinates[3] = {grid.GetXCoordinates(), grid.GetYCoordinates(),
                                          grid.GetZCoordinates()};
    Lattice lattice;
    for (int axis = 0; axis < 3; ++axis) {
        const auto x = positionsOf(coordinates[axis], points[axis], cells);
        if (!x.ok())
            return Status(x.status.code,
                          std::string("its ") + "xyz"[axis] + " coordinates " + x.status.text);
        const auto n = static_cast<int>(x->size());
        lattice.size[axis] = n;
        lattice.position[axis] = x->front();
        double step = 1.0;
        if (n > 1)
            step = (x->back() - x->front()) / (n - 1);
        else if (points[axis] > 1) // a layer of cells
            step = coordinates[axis]->GetComponent(1, 0) - coordinates[axis]->GetComponent(0, 0);
        lattice.steps[axis][axis] = step;
        if (n > 2 && !isEvenlySpaced(*x)) lattice.uneven[std::size_t(axis)] = *x;
    }
    return lattice;
}

} // namespace

Result<Lattice> latticeOf(vtkDataSet& set, bool cells)
{
    if (auto* image = vtkImageData::SafeDownCast(&set)) return latticeOfImage(*image, cells);
    if (auto* grid = vtkRectilinearGrid::SafeDownCast(&set)) return latticeOfGrid(*grid, cells);
    return Status(ErrorCode::NOT_SUPPORTED, "it is neither an image nor a rectilinear grid");
}

} // namespace vtkimage
} // namespace osgVolumizer
