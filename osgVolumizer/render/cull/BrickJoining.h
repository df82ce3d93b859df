#pragma once

#include "../volume/VolumeInstance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// Bricks in geometry and view that are not drawn.
struct LeftOutBricks
{
    std::vector<std::int64_t> empty;   ///< by their range: not read
    std::vector<std::int64_t> cutAway; ///< read, but nothing shows
    bool unreadable = false;           ///< some could not be read
};

/// Makes one of the volume's selected bricks, in a texture that has all of them, where that draws
/// the same picture faster: each brick costs every pixel something, and light that bricks in front
/// let nothing through of is not looked for behind them only within a brick. Bricks of one value,
/// and bricks with much empty space between them, are better drawn one by one. So are those of
/// volumes that are too large for one texture, or that may be: see texture3DSizeOf().
void joinBricks(VolumeInstance& volume, const Voxels& voxels, const OccupancyQuery& query,
                const LeftOutBricks& leftOut, osgUtil::CullVisitor& visitor);

} // namespace render
} // namespace osgVolumizer
