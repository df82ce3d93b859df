#pragma once

#include "../AppearanceProperties.h"
#include "../ReadVolume.h"
#include "../core/voxels/BrickLayout.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace io {

/// The values in a loader's option string; see readVoxels() and readVolume(). Those that it lacks
/// are not set.
struct VoxelOptions
{
    std::optional<glm::dvec3> spacing; ///< object units, each > 0
    std::optional<glm::dvec3> origin;  ///< object units
    std::optional<glm::dvec2> range;   ///< data values, low < high
    std::optional<glm::ivec3> brick;   ///< samples, each >= 2
    std::optional<int> overlap;        ///< samples
    std::optional<core::PartialBricks> partial;
    std::optional<bool> series;            ///< the files are time steps, not slices
    std::optional<std::string> dataset;    ///< path within a file of several
    std::optional<int> channel;            ///< of a file of several, from 0
    std::optional<std::string> dimensions; ///< names of those along x, y, z, and time
    std::optional<std::string> table;      ///< file name
    std::optional<glm::dvec3> ramp;        ///< centre and width, fractions of the range; opacity
    std::optional<glm::dmat3> axes;        ///< directions of the voxel axes, a column each
    bool axesOfFile = false;               ///< those of the file, also of a single slice
    std::vector<std::pair<const AppearanceProperty*, AppearanceProperty::Values>> properties;
    std::vector<std::string> foreign; ///< names of options that are none of these

    /// The option string again, of those that concern voxels.
    std::string voxelText() const;
    /// Whether a property is among them.
    bool has(const char* option) const;
};

/// All options, in the order in which they are best read.
std::vector<VolumeOption> voxelOptionHelp();

/// Words between blanks, each name=value; the last of a name counts. A value with blanks stands in
/// quotation marks. Refuses (VALUE_INVALID) a bad value, naming it; names of others are left alone.
OSGVOLUMIZER_EXPORT Result<VoxelOptions> parseVoxelOptions(const std::string& text);

} // namespace io
} // namespace osgVolumizer
