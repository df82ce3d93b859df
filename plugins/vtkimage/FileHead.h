#pragma once

#include "ArrayList.h"

#include <array>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace vtkimage {

/// What a file is said to hold, before VTK reads it.
struct FileHead : ArrayList
{
    bool xml = false;
    bool rectilinear = false;        ///< else an image
    std::vector<std::string> pieces; ///< files of a parallel one
    int steps = 1;                   ///< of time
    /// Of an image in XML, whose readers lose some of them; `direction` in rows.
    std::array<double, 3> spacing{1.0, 1.0, 1.0}, origin{0.0, 0.0, 0.0};
    std::array<double, 9> direction{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
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
