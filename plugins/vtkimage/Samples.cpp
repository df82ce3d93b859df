#include "Samples.h"

#include "ArrayList.h"

#include <osgVolumizer/io/Brightness.h>
#include <osgVolumizer/io/NarrowestType.h>

#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace vtkimage {

namespace {

// The voxel type of the same numbers; false where there is none.
bool sameType(int vtkType, VoxelType& type)
{
    switch (vtkType) {
    case VTK_CHAR:
        type = std::numeric_limits<char>::is_signed ? VoxelType::INT8 : VoxelType::UINT8;
        return true;
    case VTK_SIGNED_CHAR:
        type = VoxelType::INT8;
        return true;
    case VTK_UNSIGNED_CHAR:
        type = VoxelType::UINT8;
        return true;
    case VTK_SHORT:
        type = VoxelType::INT16;
        return true;
    case VTK_UNSIGNED_SHORT:
        type = VoxelType::UINT16;
        return true;
    case VTK_INT:
        type = VoxelType::INT32;
        return true;
    case VTK_UNSIGNED_INT:
        type = VoxelType::UINT32;
        return true;
    case VTK_FLOAT:
        type = VoxelType::FLOAT32;
        return true;
    default:
        return false;
    }
}

bool isFloating(const vtkDataArray& array)
{
    const int type = const_cast<vtkDataArray&>(array).GetDataType();
    return type == VTK_FLOAT || type == VTK_DOUBLE;
}

// Marks of points or cells, a number each; null where there are none.
const unsigned char* marksOf(vtkDataSetAttributes& data, vtkIdType count)
{
    auto* marks =
        vtkUnsignedCharArray::SafeDownCast(data.GetArray(vtkDataSetAttributes::GhostArrayName()));
    const bool whole =
        marks && marks->GetNumberOfComponents() == 1 && marks->GetNumberOfTuples() >= count;
    return whole ? marks->GetPointer(0) : nullptr;
}

} // namespace

Result<Samples> Samples::of(vtkDataSet& set, const FileHead& head, const ArrayInfo& info,
                            std::optional<int> channel)
{
    Samples samples;
    samples._isStep = head.steps > 1;
    samples._marks = head.marks;
    vtkDataSetAttributes& data =
        info.cells ? static_cast<vtkDataSetAttributes&>(*set.GetCellData()) : *set.GetPointData();
    const vtkIdType count = info.cells ? set.GetNumberOfCells() : set.GetNumberOfPoints();
    samples._array = data.GetArray(info.name.c_str());
    if (!samples._array)
        return Status(ErrorCode::FILE_UNREADABLE, "array \"" + info.name + "\" cannot be read");
    if (samples._array->GetNumberOfTuples() != count || count < 1)
        return Status(ErrorCode::SIZE_MISMATCH,
                      "array \"" + info.name + "\" has " +
                          std::to_string(samples._array->GetNumberOfTuples()) + " values for " +
                          std::to_string(count) + (info.cells ? " cells" : " points"));
    if (Status status = samples.choose(channel); !status.ok())
        return Status(status.code, "array \"" + info.name + "\" " + status.text);
    if (!samples._notice.empty())
        samples._notice = "array \"" + info.name + "\" " + samples._notice;
    samples.hide(set, info.cells);
    samples.scan();
    return samples;
}

Status Samples::choose(std::optional<int> channel)
{
    const int components = _array->GetNumberOfComponents();
    const bool bytes = _array->GetDataType() == VTK_UNSIGNED_CHAR;
    if (Status s = checkChannel(channel, components); !s.ok()) return s;
    _component = channel.value_or(0);
    if (channel || components == 1) return {};
    if (bytes && (components == 3 || components == 4)) {
        _how = components == 3 ? How::LUMINANCE : How::COLOR;
        return {};
    }
    const bool vector = components == 3 && isFloating(*_array);
    if (vector) _how = How::LENGTH;
    _notice = "has " + std::to_string(components) + " components, of which " +
              (vector ? "the length" : "the first") + " is shown; channel=n shows another";
    if (vector) _notice.replace(_notice.rfind("another"), 7, "one of them");
    return {};
}

// A point is hidden with all of the cells around it, too.
void Samples::hide(vtkDataSet& set, bool cells)
{
    const vtkIdType points = set.GetNumberOfPoints(), cellCount = set.GetNumberOfCells();
    const auto* pointMarks = marksOf(*set.GetPointData(), points);
    const auto* cellMarks = marksOf(*set.GetCellData(), cellCount);
    const auto hiddenCell = [cellMarks](vtkIdType c) {
        return (cellMarks[c] & vtkDataSetAttributes::HIDDENCELL) != 0;
    };
    const vtkIdType count = cells ? cellCount : points;
    if (cells ? !cellMarks : !pointMarks && !cellMarks) return;
    std::vector<bool> hidden(static_cast<std::size_t>(count), !cells && cellMarks);
    if (!cells && cellMarks) {
        vtkNew<vtkIdList> corners;
        for (vtkIdType c = 0; c < cellCount; ++c) {
            if (hiddenCell(c)) continue;
            set.GetCellPoints(c, corners);
            for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
                hidden[static_cast<std::size_t>(corners->GetId(i))] = false;
        }
    }
    for (vtkIdType i = 0; i < count; ++i)
        if (cells ? hiddenCell(i)
                  : pointMarks && (pointMarks[i] & vtkDataSetAttributes::HIDDENPOINT))
            hidden[static_cast<std::size_t>(i)] = true;
    if (std::find(hidden.begin(), hidden.end(), true) != hidden.end()) _hidden = std::move(hidden);
}

void Samples::scan()
{
    double rounding = 0.0; // to single precision
    const vtkIdType count = _array->GetNumberOfTuples();
    const bool same = sameType(_array->GetDataType(), _type);
    if (_isStep) _type = typeOfSteps();
    if (count <= std::numeric_limits<int>::max() && same && isShared() && components() == 1) {
        _range =
            core::scanRange({_array->GetVoidPointer(0), _type, 1, {static_cast<int>(count), 1, 1}});
        return;
    }
    for (vtkIdType i = 0; i < count; ++i)
        for (int c = 0; c < components(); ++c) {
            const double v = value(i, c);
            if (!std::isfinite(v)) continue;
            _range.expand({v, v});
            rounding = std::max(rounding, std::abs(v - static_cast<double>(static_cast<float>(v))));
        }
    _type = _isStep ? typeOfSteps() : typeFor(rounding);
}

VoxelType Samples::typeOfSteps() const
{
    if (_how == How::COLOR || _how == How::LUMINANCE) return VoxelType::UINT8;
    VoxelType type = VoxelType::FLOAT64;
    if (!sameType(_array->GetDataType(), type)) return VoxelType::FLOAT64;
    if (!_marks) return type;
    const bool wide = type == VoxelType::INT32 || type == VoxelType::UINT32;
    return wide ? VoxelType::FLOAT64 : VoxelType::FLOAT32;
}

VoxelType Samples::typeFor(double rounding) const
{
    constexpr double LOSS = 1.0 / (1 << 20);
    if (_how == How::COLOR || _how == How::LUMINANCE) return VoxelType::UINT8;
    const VoxelType floating = _range.empty() || rounding <= LOSS * (_range.high - _range.low)
                                   ? VoxelType::FLOAT32
                                   : VoxelType::FLOAT64;
    VoxelType type = VoxelType::FLOAT32;
    const bool same = sameType(_array->GetDataType(), type);
    if (isFloating(*_array)) return same && _how == How::COMPONENT ? type : floating;
    if (!_hidden.empty()) return rounding > 0.0 ? VoxelType::FLOAT64 : VoxelType::FLOAT32;
    return same ? type : io::narrowestInteger(_range, VoxelType::FLOAT64);
}

double Samples::value(vtkIdType tuple, int component) const
{
    if (!_hidden.empty() && _hidden[static_cast<std::size_t>(tuple)])
        return _how == How::COLOR ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    double v[3];
    switch (_how) {
    case How::COMPONENT:
        return _array->GetComponent(tuple, _component);
    case How::COLOR:
        return _array->GetComponent(tuple, component);
    case How::LUMINANCE:
    case How::LENGTH:
        break;
    }
    for (int i = 0; i < 3; ++i)
        v[i] = _array->GetComponent(tuple, i);
    return _how == How::LENGTH ? std::hypot(v[0], v[1], v[2]) : io::brightness(v, 3);
}

bool Samples::isShared() const
{
    VoxelType type = VoxelType::UINT8;
    return _hidden.empty() && sameType(_array->GetDataType(), type) && type == _type &&
           _array->HasStandardMemoryLayout() && _array->GetNumberOfComponents() == components();
}

Result<osg::ref_ptr<MemoryVoxelSource>> Samples::voxels(VoxelSource::Description d) const
{
    d.type = _type;
    d.components = components();
    const CallerReports quiet;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    if (isShared()) {
        const auto release = [keep = _array]() {};
        if (Status status = source->setExternal(d, _array->GetVoidPointer(0), release);
            !status.ok())
            return status;
        return source;
    }
    if (Status status = source->allocate(d); !status.ok()) return status;
    std::vector<double> row(static_cast<std::size_t>(d.size.x) * std::size_t(d.components));
    const std::size_t rowBytes = row.size() * voxelTypeSize(d.type);
    auto* out = static_cast<unsigned char*>(source->data());
    vtkIdType tuple = 0;
    for (std::int64_t r = 0; r < std::int64_t(d.size.y) * d.size.z; ++r, out += rowBytes) {
        for (std::size_t i = 0; i < row.size(); ++tuple)
            for (int c = 0; c < d.components; ++c)
                row[i++] = value(tuple, c);
        core::convertVoxels(row.data(), VoxelType::FLOAT64, out, d.type, row.size());
    }
    return source;
}

} // namespace vtkimage
} // namespace osgVolumizer
