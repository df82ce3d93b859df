#pragma once

#include <osgVolumizer/core/Status.h>

#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace vtkimage {

/// An array of numbers in a file.
struct ArrayInfo
{
    std::string name;
    bool cells = false; ///< a value for each cell, not for each point
    int components = 1;
};

/// The arrays of a data set of VTK's, of any kind, and which of them is meant.
struct ArrayList
{
    std::vector<ArrayInfo> arrays;    ///< those that can be chosen: points first
    std::string scalars, cellScalars; ///< the active ones' names; empty: none
    bool marks = false;               ///< some points or cells may be hidden

    /// Notes an array, unless it is there; of VTK's own that there are marks.
    void add(const ArrayInfo& array);
    /// By a name of nameOf(), or "points:..." or "cells:..."; of no name the active scalars, else
    /// the first of one component, else the first. VALUE_INVALID, in words that do not name the
    /// file.
    Result<ArrayInfo> choose(const std::string& name) const;
    /// Cells whose name points have, too, are "cells:...".
    std::string nameOf(const ArrayInfo& array) const;
};

/// INDEX_OUT_OF_RANGE where an array has no such channel; what is said goes after its name.
Status checkChannel(std::optional<int> channel, int components);

} // namespace vtkimage
} // namespace osgVolumizer
