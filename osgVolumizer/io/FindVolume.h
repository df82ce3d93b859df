#pragma once

#include "RawName.h"

#include <osgDB/Options>

#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace io {

/// The files that a name stands for.
struct FoundVolume
{
    std::string path;               ///< absolute, of the same form as the name
    std::vector<std::string> files; ///< at least one
    bool several = false;           ///< a folder or a pattern: of slices, or time steps
    std::optional<RawName> raw;     ///< what they are, if that stood in the name
};

/// Looks for a file, a folder, a pattern or a raw file (see readVoxels()) along OSG's data path;
/// `steps`: for a folder or a pattern of volumes, not of slices. FILE_NOT_FOUND, VALUE_INVALID for
/// the name of a raw file that is wrong.
Result<FoundVolume> findVolume(std::string name, const osgDB::Options* options, bool steps);

} // namespace io
} // namespace osgVolumizer
