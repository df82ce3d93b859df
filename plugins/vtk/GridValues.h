#pragma once

#include <osgVolumizer/core/Status.h>

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <optional>
#include <string>

class vtkUnstructuredGrid;

namespace osgVolumizer {
namespace vtk {

/// What of a grid's data is shown: scalars of points or cells, or colours of points.
class GridValues
{
public:
    /// \param name of a point or else a cell array, "points:..." or "cells:..."; empty: the active
    /// scalars of points, else of cells, else the first array of one component, else the first
    /// \param channel of its components; without: three or four of unsigned char are a colour,
    /// three of floating point a vector, as its length, others their first
    /// VALUE_INVALID (no such array), INDEX_OUT_OF_RANGE (of its channels), SIZE_MISMATCH, in words
    /// that do not name the file.
    static Result<GridValues> of(vtkUnstructuredGrid& grid, const std::string& name,
                                 std::optional<int> channel);

    std::string name() const { return _array->GetName() ? _array->GetName() : ""; }
    /// What was made of several components, to be told; empty for nothing special.
    const std::string& notice() const { return _notice; }
    bool ofCells() const { return _ofCells; }
    bool isColor() const { return _how == How::COLOR; }
    /// Of a point or cell. Expects no colours.
    double scalar(vtkIdType tuple) const;
    /// Component 0 to 3 of a colour of a point, within [0, 1].
    double color(vtkIdType point, int component) const;

private:
    enum class How
    {
        COMPONENT,
        LENGTH,
        COLOR
    };
    Status choose(std::optional<int> channel);

    vtkSmartPointer<vtkDataArray> _array;
    bool _ofCells = false;
    How _how = How::COMPONENT;
    int _component = 0;
    std::string _notice;
};

} // namespace vtk
} // namespace osgVolumizer
