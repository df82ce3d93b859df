#pragma once

#include "../textures/SelectedBrick.h"

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What is drawn from one brick: a run of triangles, and the place of the brick.
struct BrickBatch
{
    DrawnBrick brick;                                  ///< none without voxels, and where joined
    DrawnBrick nextBrick;                              ///< of the second of two time steps; or none
    float stepFraction = 0.0f;                         ///< of the second
    std::shared_ptr<const JoinedBricks> joined;        ///< several bricks in one texture; else null
    std::shared_ptr<const BrickCells> cells;           ///< null where nothing is known
    glm::vec3 clipMin{0.0f}, clipMax{0.0f};            ///< frame; of what is drawn
    glm::vec3 brickMin{0.0f}, brickMax{0.0f};          ///< frame; of what the texture has
    glm::vec3 textureScale{1.0f}, textureOffset{0.0f}; ///< voxel -> texture coordinate
    /// How many steps of a ray are taken as one, evenly between where the first begins and the last
    /// ends, so that bricks that differ in it still meet: where samples are further apart, and
    /// ALL_STEPS where all have one value.
    float stride = 1.0f;
    unsigned firstIndex = 0, indexCount = 0;
};

constexpr float ALL_STEPS = 1e9f;

/// Triangles far to near, by brick. Immutable once made.
struct VolumeMesh
{
    int stride = 3; ///< floats a vertex
    int slabOffset = -1, voxelCoordinateOffset = -1, colorOffset = -1, colorSize = 0;
    int spacingOffset = -1; ///< slices with a thickness each; else all have VolumePart::step
    int positionOffset = 0;
    std::vector<float> vertices;
    std::vector<unsigned> indices;
    std::vector<BrickBatch> batches;
    unsigned faceCount = 0;
    /// A mesh that is kept from frame to frame, whose vertices and indices these are; or null.
    std::shared_ptr<const VolumeMesh> arrays;

    const std::vector<float>& vertexArray() const { return arrays ? arrays->vertices : vertices; }
    const std::vector<unsigned>& indexArray() const { return arrays ? arrays->indices : indices; }
};

} // namespace render
} // namespace osgVolumizer
