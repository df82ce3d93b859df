#pragma once

#include "../Export.h"
#include "../Status.h"
#include "../geometry/Box.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A brick of a level. Its samples lie `spacing` voxels apart: sample i at spacing * i + offset.
struct TreeBrick
{
    int level = 0;
    glm::ivec3 coordinates{0}; ///< among the bricks of the level
    Box3i samples;             ///< of the level, half-open; what filters need within the clip box
    Box3d clipBox;             ///< voxel frame of level 0
    double spacing = 1.0, offset = 0.0;
};

/// The bricks of a volume and of coarser copies of it. Level 0 is the volume; each further level
/// has half as many samples on each axis, rounded up, each of them the mean of eight: sample i of
/// level l lies at 2^l i + (2^l - 1) / 2 in the voxel frame of level 0. A brick's clip box is
/// exactly that of its children, so that any choice of bricks in which none is above another tiles
/// the volume without gap or overlap. Bricks are numbered over all levels.
class OSGVOLUMIZER_CORE_EXPORT BrickTree
{
public:
    static constexpr int MAXIMUM_LEVELS = 24;
    static constexpr std::int64_t MAXIMUM_BRICKS = std::int64_t(1) << 40;

    BrickTree() = default;
    /// \param size samples of level 0 per axis, each >= 1
    /// \param levels 1 to MAXIMUM_LEVELS
    /// \param step voxels along the edge of a clip box of level 0, >= 1
    /// \param overlap samples that neighbours share, >= 1: as BrickLayout's
    /// Refuses anything else (VALUE_INVALID), and more than MAXIMUM_BRICKS (TOO_LARGE).
    static Result<BrickTree> create(const glm::ivec3& size, int levels, int step, int overlap = 1);
    /// Samples of a level per axis.
    static glm::ivec3 levelSize(const glm::ivec3& size, int level);
    /// As many levels as leave one brick at the top.
    static int levelsFor(const glm::ivec3& size, int step);

    /// 0 where there is no tree.
    int levelCount() const { return static_cast<int>(_levels.size()); }
    glm::ivec3 size() const { return _size; }
    int step() const { return _step; }
    /// Bricks of a level per axis.
    glm::ivec3 count(int level) const { return _levels[static_cast<std::size_t>(level)].count; }
    std::int64_t brickCount() const { return _brickCount; }
    std::int64_t brickCount(int level) const;
    std::int64_t index(int level, const glm::ivec3& coordinates) const;
    TreeBrick brick(std::int64_t index) const;
    /// Bricks of the coarsest level, and the children of a brick, far to near along any ray from
    /// the eye, wherever it is. \param eyeVoxel homogeneous: w = 0 is a direction towards the eye
    std::vector<std::int64_t> roots(const glm::dvec4& eyeVoxel) const;
    std::vector<std::int64_t> children(std::int64_t index, const glm::dvec4& eyeVoxel) const;

private:
    struct Level
    {
        glm::ivec3 size{0}, count{0};
        std::int64_t first = 0; ///< number of its first brick
    };

    int levelOf(std::int64_t index) const;
    glm::ivec3 coordinatesOf(int level, std::int64_t index) const;
    double cut(int level, int brick, int axis) const;
    void addFarToNear(int level, const glm::ivec3& first, const glm::ivec3& last,
                      const glm::dvec4& eyeVoxel, std::vector<std::int64_t>& bricks) const;

    glm::ivec3 _size{0};
    int _step = 0, _overlap = 1;
    std::int64_t _brickCount = 0;
    std::vector<Level> _levels;
};

/// The samples of level 0 that those of a brick stand for.
OSGVOLUMIZER_CORE_EXPORT Box3i samplesBelow(const BrickTree& tree, const TreeBrick& brick);

} // namespace core
} // namespace osgVolumizer
