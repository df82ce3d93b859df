#pragma once

#include "FileHead.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/VoxelSource.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <optional>
#include <vector>

class vtkDataSet;

namespace osgVolumizer {
namespace vtkimage {

/// An array of a data set as the samples of voxels: its numbers, or one made of several components.
/// Hidden points and cells are NaN, which is a hole; colours of them are all zero.
class Samples
{
public:
    /// \param channel of its components; without: three or four of unsigned char are a colour, RGB
    /// as luminance, three of floating point a vector, as its length, others their first.
    /// \param head says whether it is one of several time steps, whose types have to be the same
    /// SIZE_MISMATCH, INDEX_OUT_OF_RANGE and FILE_UNREADABLE, in words that do not name the file.
    static Result<Samples> of(vtkDataSet& set, const FileHead& head, const ArrayInfo& info,
                              std::optional<int> channel);

    /// What was made of several components, to be told; empty for nothing special.
    const std::string& notice() const { return _notice; }
    int components() const { return _how == How::COLOR ? 4 : 1; }
    /// The narrowest that holds what is there; float32 for float64 that loses less than 2^-20 of
    /// the range. Of a time step, whatever is there: that of the file, FLOAT64 for 64-bit numbers
    /// and lengths of such, a float for integers of which some may be hidden.
    VoxelType type() const { return _type; }
    const core::ValueRange& range() const { return _range; }
    /// Voxels of `description`, whose type and components are set here; without a copy where that
    /// can be. Texts of errors do not name the file.
    Result<osg::ref_ptr<MemoryVoxelSource>> voxels(VoxelSource::Description description) const;

private:
    enum class How
    {
        COMPONENT,
        LUMINANCE,
        COLOR,
        LENGTH
    };
    Status choose(std::optional<int> channel);
    void hide(vtkDataSet& set, bool cells);
    void scan();
    VoxelType typeFor(double rounding) const;
    VoxelType typeOfSteps() const;
    double value(vtkIdType tuple, int component) const;
    bool isShared() const;

    vtkSmartPointer<vtkDataArray> _array;
    How _how = How::COMPONENT;
    int _component = 0;
    bool _isStep = false, _marks = false; ///< of several; points or cells may be hidden
    std::vector<bool> _hidden;            ///< empty where nothing is
    VoxelType _type = VoxelType::UINT8;
    core::ValueRange _range;
    std::string _notice;
};

} // namespace vtkimage
} // namespace osgVolumizer
