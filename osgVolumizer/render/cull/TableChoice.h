#pragma once

#include "../context/Precision.h"
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
    bool exactFiltering = false; ///< filtering as precise as that of textures would not keep it
};

/// Expects voxels. Reports why an error tolerance cannot be kept.
TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const Precision& ofTextures);

} // namespace render
} // namespace osgVolumizer
