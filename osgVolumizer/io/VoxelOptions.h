#pragma once

#include "../core/Export.h"
#include "../core/Status.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>

namespace osgVolumizer {
namespace io {

/// The values in a loader's option string; see readVoxels(). Those that it lacks are not set.
struct VoxelOptions
{
    std::optional<glm::dvec3> spacing; ///< object units, each > 0
    std::optional<glm::dvec3> origin;  ///< object units
    std::optional<glm::dvec2> range;   ///< data values, low < high
    std::optional<glm::ivec3> brick;   ///< samples, each >= 2
    std::optional<double> unit;        ///< object units, > 0
    std::optional<std::string> table;  ///< file name

    /// The option string again, of those that concern voxels: all but unit and table.
    std::string voxelText() const;
};

/// Words between blanks, each name=value; the last of a name counts. Refuses (VALUE_INVALID) an
/// unknown name and a bad value, naming both.
OSGVOLUMIZER_EXPORT Result<VoxelOptions> parseVoxelOptions(const std::string& text);

} // namespace io
} // namespace osgVolumizer
