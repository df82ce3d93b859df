#pragma once

#include "RawName.h"

#include <string_view>

namespace osgVolumizer {
namespace io {

/// What the header of a NumPy file (.npy) says of the bytes behind it.
struct NumpyHeader
{
    RawName raw; ///< of the first time step; without a file name
    int steps = 1;

    /// `head` is the beginning of the file, up to 64 KiB. Arrays of z,y,x, of y,x, or of
    /// time,z,y,x in C's order, or the reverse in Fortran's. The text of a refusal lacks the name
    /// of the file: FILE_UNREADABLE; NOT_SUPPORTED for other ranks, and for numbers that no voxels
    /// are of. Source: NumPy's "numpy.lib.format", versions 1 to 3.
    static OSGVOLUMIZER_EXPORT Result<NumpyHeader> parse(std::string_view head);
};

} // namespace io
} // namespace osgVolumizer
