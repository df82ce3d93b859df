#pragma once

#include "Samples.h"

namespace osgVolumizer {
namespace medical {

/// A file of NRRD, MetaImage, MRC, Bio-Rad PIC, GIPL or MINC 2, read by ITK into memory. What a
/// file of a few bytes claims is checked before anything is allocated. Texts begin with the path.
Result<Samples> readItkFile(const std::string& path);

} // namespace medical
} // namespace osgVolumizer
