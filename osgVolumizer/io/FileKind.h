#pragma once

#include "../core/Export.h"

#include <string>
#include <string_view>

namespace osgVolumizer {
namespace io {

/// What kind of volume file something is, by how it begins; where that says nothing, by the end of
/// its name.
enum class FileKind
{
    IMAGE, ///< of OpenImageIO, or nothing that is known here
    NUMPY,
    DICOM,
    MEDICAL, ///< of ITK but for DICOM: NIfTI, Analyze, NRRD, MetaImage, MRC, Bio-Rad PIC, MINC
    VTK,     ///< a data set of VTK's own formats
    OPENVDB,
    HDF5,
    NETCDF, ///< classic, or HDF5 of such a name
    ZARR    ///< a folder
};

/// `head` is the beginning of a file, 1024 bytes or all of it; `name` may be a path.
OSGVOLUMIZER_EXPORT FileKind fileKindOf(std::string_view head, const std::string& name);
/// Of a file or folder; IMAGE where there is none, or it cannot be read.
OSGVOLUMIZER_EXPORT FileKind fileKindOf(const std::string& path);

} // namespace io
} // namespace osgVolumizer
