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
    bool adaptive = false;       ///< steps are as long as the light that they give allows
    bool exactFiltering = false; ///< filtering as precise as that of textures would not keep it
    double expectedError = 0.0;  ///< root mean square; 0: not known
    bool refining = false;       ///< this one is safe; a cheaper one is being looked for
};

/// Expects voxels. Reports why an error tolerance cannot be kept.
TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const Precision& ofTextures);

/// Of scalars of a range: the table's points where these are read by a shader that is exact, and
/// entries where a ray function gathers values.
TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const osg::Vec2d& scalarRange);

} // namespace render
} // namespace osgVolumizer
