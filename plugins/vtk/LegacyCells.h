#pragma once

#include <osgVolumizer/core/Status.h>

#include <string>

namespace osgVolumizer {
namespace vtk {

/// Whether the CELLS of a legacy file add up, and the faces of polyhedra in it: VTK 9.1 takes the
/// numbers on trust and reads beyond its buffer where they do not. \param content of the whole
/// file. FILE_UNREADABLE, with words that do not name the file.
Status checkLegacyCells(const std::string& content);

} // namespace vtk
} // namespace osgVolumizer
