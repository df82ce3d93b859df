#pragma once

#include "../textures/TableTextures.h"
#include "../volume/PreparedGeometry.h"

namespace osgVolumizer {
namespace render {

/// The table that a volume is looked up in, and how finely it is to be sampled.
struct TableChoice
{
    TableTexture table;
    /// For an error tolerance; none where none is asked for, or it cannot be kept.
    std::optional<double> periodVoxel;
};

/// Expects voxels. Reports why an error tolerance cannot be kept.
TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared);

} // namespace render
} // namespace osgVolumizer
