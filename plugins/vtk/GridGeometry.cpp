#include "GridGeometry.h"

#include <osgVolumizer/core/geometry/CellSplitting.h>
#include <osgVolumizer/core/geometry/TetraMesh.h>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace osgVolumizer {
namespace vtk {

namespace {

using Index = core::TetraSet::Index;

// A VTK cell kind as ours, with our order of its corners.
struct Kind
{
    int type;
    core::CellKind kind;
    int order[8];
};
constexpr Kind KINDS[] = {{VTK_TETRA, core::CellKind::TETRA, {0, 1, 2, 3}},
                          {VTK_PYRAMID, core::CellKind::PYRAMID, {0, 1, 2, 3, 4}},
                          {VTK_WEDGE, core::CellKind::PRISM, {0, 1, 2, 3, 4, 5}},
                          {VTK_HEXAHEDRON, core::CellKind::HEXA, {0, 1, 2, 3, 4, 5, 6, 7}},
                          {VTK_VOXEL, core::CellKind::HEXA, {0, 1, 3, 2, 4, 5, 7, 6}}};

// Points, lines and faces have no volume.
bool isFlat(int type)
{
    return type <= VTK_QUAD || type == VTK_QUADRATIC_EDGE || type == VTK_QUADRATIC_TRIANGLE ||
           type == VTK_QUADRATIC_QUAD;
}

// Whether every cell's points lie where the grid says that they begin.
Status checkOffsets(vtkUnstructuredGrid& grid)
{
    vtkCellArray* cells = grid.GetCells();
    const vtkIdType count = grid.GetNumberOfCells();
    if (!cells || cells->GetNumberOfCells() != count ||
        (count > 0 && grid.GetCellTypesArray()->GetNumberOfTuples() != count))
        return {ErrorCode::SIZE_MISMATCH, "the numbers of cells and of their types differ"};
    vtkDataArray& offsets = *cells->GetOffsetsArray();
    const vtkIdType size = cells->GetNumberOfConnectivityIds();
    double last = 0.0;
    for (vtkIdType c = 0; c <= count && count > 0; ++c) {
        const double offset = offsets.GetComponent(c, 0);
        if (!(offset >= last && offset <= static_cast<double>(size)))
            return {ErrorCode::INDEX_OUT_OF_RANGE,
                    "the points of cell " + std::to_string(c) + " begin out of order", c};
        last = offset;
    }
    return {};
}

Status appendCells(vtkUnstructuredGrid& grid, std::vector<Index>& indices)
{
    if (Status s = checkOffsets(grid); !s) return s;
    const vtkIdType points = grid.GetNumberOfPoints();
    for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
        const int type = grid.GetCellType(c);
        const Kind* kind = std::find_if(std::begin(KINDS), std::end(KINDS),
                                        [type](const Kind& k) { return k.type == type; });
        if (kind == std::end(KINDS)) {
            if (isFlat(type)) continue;
            return {ErrorCode::VALUE_INVALID,
                    "cell " + std::to_string(c) + " is of VTK's type " + std::to_string(type) +
                        "; tetrahedra, pyramids, wedges, hexahedra and voxels are known",
                    c};
        }
        vtkIdType count = 0;
        const vtkIdType* corners = nullptr;
        grid.GetCellPoints(c, count, corners);
        if (count != core::cellSize(kind->kind))
            return {ErrorCode::SIZE_MISMATCH,
                    "cell " + std::to_string(c) + " has " + std::to_string(count) + " points", c};
        Index own[8];
        for (vtkIdType i = 0; i < count; ++i) {
            const vtkIdType point = corners[kind->order[i]];
            if (point < 0 || point >= points)
                return {ErrorCode::INDEX_OUT_OF_RANGE,
                        "cell " + std::to_string(c) + " refers to point " + std::to_string(point) +
                            " of " + std::to_string(points),
                        c};
            own[i] = static_cast<Index>(point);
        }
        core::splitCell(kind->kind, own, indices);
    }
    if (indices.empty()) return {ErrorCode::VALUE_INVALID, "there are no cells with a volume"};
    return {};
}

Result<vtkDataArray*> findArray(vtkUnstructuredGrid& grid, const std::string& name)
{
    vtkPointData& data = *grid.GetPointData();
    vtkDataArray* array = nullptr;
    if (!name.empty())
        array = data.GetArray(name.c_str());
    else if (data.GetScalars())
        array = data.GetScalars();
    else if (data.GetNumberOfArrays() == 1)
        array = data.GetArray(0);
    if (!array) {
        std::string known;
        for (int i = 0; i < data.GetNumberOfArrays(); ++i)
            known += std::string(i ? ", " : "") +
                     (data.GetArrayName(i) ? data.GetArrayName(i) : "(unnamed)");
        return Status(ErrorCode::VALUE_INVALID,
                      (name.empty() ? std::string("there are no active point scalars")
                                    : "there is no point array '" + name + "'") +
                          (known.empty() ? std::string() : "; there are: " + known));
    }
    const int components = array->GetNumberOfComponents();
    if (components != 1 && components != 3 && components != 4)
        return Status(ErrorCode::VALUE_INVALID, "the point array has " +
                                                    std::to_string(components) +
                                                    " components; scalars have 1, colours 3 or 4");
    if (array->GetNumberOfTuples() < grid.GetNumberOfPoints())
        return Status(ErrorCode::SIZE_MISMATCH,
                      "the point array has " + std::to_string(array->GetNumberOfTuples()) +
                          " values for " + std::to_string(grid.GetNumberOfPoints()) + " points");
    return array;
}

Status setColors(vtkDataArray& array, core::VertexArray& vertices)
{
    const double scale = vtkUnsignedCharArray::SafeDownCast(&array) ? 1.0 / 255.0 : 1.0;
    const int components = array.GetNumberOfComponents();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        double* color = vertices.record(i) + vertices.format().colorOffset();
        color[3] = 1.0;
        for (int k = 0; k < components; ++k) {
            const double v = array.GetComponent(static_cast<vtkIdType>(i), k) * scale;
            if (!(v >= 0.0 && v <= 1.0))
                return {ErrorCode::VALUE_INVALID,
                        "the colour of point " + std::to_string(i) + " is not within [0, 1]",
                        static_cast<std::int64_t>(i)};
            color[k] = v;
        }
    }
    return {};
}

// One sample of margin at both ends, so that the ends of the range lie inside the row.
Status setScalars(vtkDataArray& array, GridGeometry& geometry)
{
    core::VertexArray& vertices = geometry.tetras.vertices;
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double v = array.GetComponent(static_cast<vtkIdType>(i), 0);
        if (!std::isfinite(v))
            return {ErrorCode::VALUE_INVALID,
                    "the scalar of point " + std::to_string(i) + " is not finite",
                    static_cast<std::int64_t>(i)};
        low = std::min(low, v);
        high = std::max(high, v);
    }
    // A range that single precision can tell apart.
    const double least = 1e-6 * std::max({std::abs(low), std::abs(high), 1e-30});
    if (!(high - low > least)) high = low + least;
    geometry.range.set(low, high);
    geometry.scalars = true;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double v = array.GetComponent(static_cast<vtkIdType>(i), 0);
        const double place = 1.0 + (v - low) / (high - low) * GridGeometry::SAMPLES;
        vertices.setVoxelCoordinate(i, {place, 1.0, 1.0});
    }
    return {};
}

} // namespace

Result<GridGeometry> convertGrid(vtkUnstructuredGrid& grid, const std::string& arrayName)
{
    constexpr vtkIdType MOST = vtkIdType(1) << 31;
    if (grid.GetNumberOfPoints() > MOST)
        return Status(ErrorCode::TOO_LARGE,
                      "there are " + std::to_string(grid.GetNumberOfPoints()) + " points");
    const Result<vtkDataArray*> array = findArray(grid, arrayName);
    if (!array) return array.status;
    GridGeometry geometry;
    if ((*array)->GetName()) geometry.name = (*array)->GetName();
    const bool colors = (*array)->GetNumberOfComponents() > 1;
    core::TetraSet& set = geometry.tetras;
    set.vertices =
        core::VertexArray(colors ? core::VertexLayout::C4F_V3F : core::VertexLayout::T3F_V3F);
    set.vertices.resize(static_cast<std::size_t>(grid.GetNumberOfPoints()));
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
        double p[3];
        grid.GetPoint(static_cast<vtkIdType>(i), p);
        set.vertices.setPosition(i, {p[0], p[1], p[2]});
    }
    if (Status s = appendCells(grid, set.indices); !s) return s;
    if (Status s = colors ? setColors(**array, set.vertices) : setScalars(**array, geometry); !s)
        return s;
    if (Status s = set.validate(); !s) return s;
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
