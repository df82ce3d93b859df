#include "VolumeMesh.h"

namespace osgVolumizer {
namespace render {

BrickBatch batchOf(const SelectedBrick& brick)
{
    BrickBatch batch;
    batch.brick = brick.texels;
    batch.clipMin = glm::vec3(brick.box.min);
    batch.clipMax = glm::vec3(brick.box.max);
    batch.brickMin = glm::vec3(brick.clipBox.min);
    batch.brickMax = glm::vec3(brick.clipBox.max);
    batch.cells = brick.cells;
    batch.joined = brick.joined;
    batch.textureScale = brick.textureScale;
    batch.textureOffset = brick.textureOffset;
    return batch;
}

} // namespace render
} // namespace osgVolumizer
