#pragma once

#include "BrickCells.h"
#include "DrawnBrick.h"

#include "../../core/geometry/Box.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>

namespace osgVolumizer {
namespace render {

struct JoinedBricks;

/// A brick that this frame may have to draw.
struct SelectedBrick
{
    std::int64_t index = 0;
    core::Box3d box;           ///< frame; clip box, cut down to the geometry and to what shows
    core::Box3d clipBox;       ///< voxel frame
    DrawnBrick texels;         ///< none where joined
    DrawnBrick nextTexels;     ///< of the second of two time steps, or none
    float stepFraction = 0.0f; ///< of the second
    glm::vec3 textureScale{1.0f}, textureOffset{0.0f};
    std::shared_ptr<const BrickCells> cells;    ///< null where nothing is known
    std::shared_ptr<const JoinedBricks> joined; ///< null for one brick with a texture of its own
    float stride = 1.0f;                        ///< see BrickBatch
    int brickCount = 1;                         ///< how many it stands for
};

} // namespace render
} // namespace osgVolumizer
