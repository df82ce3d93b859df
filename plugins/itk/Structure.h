#pragma once

#include <osgVolumizer/core/Status.h>

#include <string>

namespace osgVolumizer {
namespace medical {

/// Whether the elements of a DICOM file, up to its pixels, lie within it: each has a head, and as
/// many bytes as that says. GDCM ends the process over some that do not. FILE_UNREADABLE where they
/// do not, NOT_SUPPORTED for a DICOMDIR, with a text that begins with the path. What is of no form
/// that is known here (without the word DICM, deflated, or odd) is passed, for GDCM to judge.
Status checkStructure(const std::string& path);

} // namespace medical
} // namespace osgVolumizer
