#pragma once

#include <osgVolumizer/core/Status.h>

#include <array>
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

/// What a file is said to hold, before VTK reads it.
struct FileHead
{
    bool xml = false;
    bool rectilinear = false;         ///< else an image
    std::vector<std::string> pieces;  ///< files of a parallel one
    int steps = 1;                    ///< of time
    std::vector<ArrayInfo> arrays;    ///< those that can be chosen: points first
    std::string scalars, cellScalars; ///< the active ones' names; empty: none
    bool marks = false;               ///< some points or cells may be hidden
    /// Of an image in XML, whose readers lose some of them; `direction` in rows.
    std::array<double, 3> spacing{1.0, 1.0, 1.0}, origin{0.0, 0.0, 0.0};
    std::array<double, 9> direction{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

    /// Notes an array, unless it is there; of VTK's own that there are marks.
    void add(const ArrayInfo& array);
    /// By a name of nameOf(), or "points:..." or "cells:..."; of no name the active scalars, else
    /// the first of one component, else the first. VALUE_INVALID, in words that do not name the
    /// file.
    Result<ArrayInfo> choose(const std::string& name) const;
    /// Cells whose name points have, too, are "cells:...".
    std::string nameOf(const ArrayInfo& array) const;
};

/// Reads how a file begins, and checks that it can hold what it says, since VTK's readers take that
/// on trust. FILE_UNREADABLE where not; NOT_SUPPORTED for data sets that are no volumes. Texts
/// begin with the path.
Result<FileHead> readHead(const std::string& path);

// The parts of readHead(), whose texts do not name the file.

/// Of the legacy format: all sections are passed over, and have to fit into the file.
Result<FileHead> readLegacyHead(const std::string& path);
/// Of the XML formats: every array has to fit into the file, as densely as its compressor packs.
Result<FileHead> readXmlHead(const std::string& path);
/// What to say of data sets that are no volumes. \param kind as the file writes it
Status notAVolume(const std::string& kind);

} // namespace vtkimage
} // namespace osgVolumizer
