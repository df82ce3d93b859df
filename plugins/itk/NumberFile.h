#pragma once

#include "Samples.h"

#include <string>

namespace osgVolumizer {
namespace medical {

/// The beginning of a file, packed by gzip or not: `count` bytes or all of it.
std::string headOf(const std::string& path, std::size_t count);

/// Reads all numbers of `samples`, which begin at byte `offset` of a file (unpacked), into memory.
/// FILE_UNREADABLE where there are too few, which is looked at before there is any memory; a text
/// begins with the path.
Status readNumbers(const std::string& path, std::int64_t offset, bool swapped, Samples& samples);

/// Refuses (FILE_UNREADABLE) a file of `path` that has fewer than `needed` bytes; where it is
/// packed, fewer than those could be packed to.
Status checkBytes(const std::string& path, std::int64_t found, std::int64_t needed, bool packed);

/// Files of NIfTI, Analyze and FreeSurfer. Texts begin with the path.
Result<Samples> readNifti(const std::string& path);
Result<Samples> readMgh(const std::string& path);

} // namespace medical
} // namespace osgVolumizer
