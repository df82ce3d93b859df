#include "GridValues.h"

#include "../vtkimage/ArrayList.h"

#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>

namespace osgVolumizer {
namespace vtk {

namespace {

void list(vtkDataSetAttributes& data, bool cells, vtkimage::ArrayList& arrays)
{
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
        vtkDataArray* array = data.GetArray(i);
        const bool ofShape =
            array && (array == data.GetHigherOrderDegrees() || array == data.GetRationalWeights());
        if (array && array->GetName() && !ofShape)
            arrays.add({array->GetName(), cells, array->GetNumberOfComponents()});
    }
    if (data.GetScalars() && data.GetScalars()->GetName())
        (cells ? arrays.cellScalars : arrays.scalars) = data.GetScalars()->GetName();
}

} // namespace

Result<GridValues> GridValues::of(vtkUnstructuredGrid& grid, const std::string& name,
                                  std::optional<int> channel)
{
    vtkimage::ArrayList arrays;
    list(*grid.GetPointData(), false, arrays);
    list(*grid.GetCellData(), true, arrays);
    const Result<vtkimage::ArrayInfo> chosen = arrays.choose(name);
    if (!chosen.ok()) return chosen.status;
    GridValues values;
    values._ofCells = chosen->cells;
    values._array = chosen->cells ? grid.GetCellData()->GetArray(chosen->name.c_str())
                                  : grid.GetPointData()->GetArray(chosen->name.c_str());
    const vtkIdType count = chosen->cells ? grid.GetNumberOfCells() : grid.GetNumberOfPoints();
    const std::string title = "array \"" + chosen->name + "\" ";
    if (values._array->GetNumberOfTuples() < count)
        return Status(ErrorCode::SIZE_MISMATCH,
                      title + "has " + std::to_string(values._array->GetNumberOfTuples()) +
                          " values for " + std::to_string(count) +
                          (chosen->cells ? " cells" : " points"));
    if (const Status status = values.choose(channel); !status.ok())
        return Status(status.code, title + status.text);
    if (!values._notice.empty()) values._notice = title + values._notice;
    return values;
}

Status GridValues::choose(std::optional<int> channel)
{
    const int components = _array->GetNumberOfComponents(), type = _array->GetDataType();
    if (components < 1) return {ErrorCode::SIZE_MISMATCH, "has no components"};
    if (Status s = vtkimage::checkChannel(channel, components); !s.ok()) return s;
    _component = channel.value_or(0);
    if (channel || components == 1) return {};
    if (type == VTK_UNSIGNED_CHAR && (components == 3 || components == 4)) {
        if (_ofCells)
            return {ErrorCode::NOT_SUPPORTED,
                    "has colours of cells, not of points; channel=n shows one of their channels"};
        _how = How::COLOR;
        return {};
    }
    const bool vector = components == 3 && (type == VTK_FLOAT || type == VTK_DOUBLE);
    if (vector) _how = How::LENGTH;
    _notice = "has " + std::to_string(components) + " components, of which " +
              (vector ? "the length is shown; channel=n shows one of them"
                      : "the first is shown; channel=n shows another");
    return {};
}

double GridValues::scalar(vtkIdType tuple) const
{
    if (_how == How::COMPONENT) return _array->GetComponent(tuple, _component);
    return std::hypot(_array->GetComponent(tuple, 0), _array->GetComponent(tuple, 1),
                      _array->GetComponent(tuple, 2));
}

double GridValues::color(vtkIdType point, int component) const
{
    if (component == 3 && _array->GetNumberOfComponents() == 3) return 1.0;
    return _array->GetComponent(point, component) / 255.0;
}

} // namespace vtk
} // namespace osgVolumizer
