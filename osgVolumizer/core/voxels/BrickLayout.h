#pragma once

#include "../Export.h"
#include "../Status.h"
#include "../geometry/Box.h"

#include <cstdint>

namespace osgVolumizer {
namespace core {

/// One brick: the samples it holds, and the part of the voxel frame that is drawn from it.
struct BrickPlace
{
    Box3i samples; ///< sample (i,j,k) range, half-open; neighbours share `overlap` samples
    /// Voxel frame. Clip boxes of neighbours tile [0, N-1] without gap or overlap; an axis of one
    /// sample, a slice, is as thick as the distance to a next one would be: [-0.5, 0.5].
    Box3d clipBox;
};

/// Selects what is done where the volume's size is no multiple of the brick's.
enum class PartialBricks : int
{
    SHRINK_TO_FIT, ///< the last brick of each axis is smaller
    TRUNCATE,      ///< what does not fill a brick is left out
    AVERAGE_UP     ///< all bricks keep their size: the last is moved back, sharing more samples
};

/// Cuts a volume of N samples an axis into bricks. Overlap 1 is enough for trilinear
/// filtering, 3 for cubic, +2 for gradients by central differences. A regular lattice of clip
/// boxes, so visibility order is exact per axis.
class OSGVOLUMIZER_CORE_EXPORT BrickLayout
{
public:
    /// Each brick costs some 2 kB, and time in every frame, whether or not it shows anything: half
    /// a gigabyte for so many. A volume of 4096^3 samples in bricks of 64^3 is within it.
    static constexpr std::int64_t MAXIMUM_BRICKS = std::int64_t(1) << 18;
    /// Twice the samples on each axis: bricks twice as large as their overlap. What is filtered by
    /// cubics and lit, and so needs overlap 5, may be in bricks of 10^3.
    static constexpr double MAXIMUM_REPETITION = 8.0;
    /// 16 MiB as floats.
    static constexpr double FREE_SAMPLES = 1 << 22;

    BrickLayout() = default;
    /// \param size samples of the volume per axis, each >= 1
    /// \param brickSize samples of a brick per axis, each > overlap; larger than `size` means one
    /// brick
    /// Refuses anything else (VALUE_INVALID); more than MAXIMUM_BRICKS, and bricks that by their
    /// overlap hold more than MAXIMUM_REPETITION times the volume's samples, unless those are no
    /// more than FREE_SAMPLES (TOO_LARGE).
    static Result<BrickLayout> create(const glm::ivec3& size, const glm::ivec3& brickSize,
                                      int overlap = 1,
                                      PartialBricks partial = PartialBricks::SHRINK_TO_FIT);

    glm::ivec3 size() const { return _size; }
    glm::ivec3 brickSize() const { return _brickSize; }
    int overlap() const { return _overlap; }
    PartialBricks partialBricks() const { return _partial; }
    /// Bricks per axis.
    glm::ivec3 count() const { return _count; }
    std::int64_t brickCount() const
    {
        return std::int64_t(_count.x) * _count.y * std::int64_t(_count.z);
    }
    /// Linear index of brick (i,j,k): i fastest.
    std::int64_t index(const glm::ivec3& brick) const
    {
        return brick.x + std::int64_t(_count.x) * (brick.y + std::int64_t(_count.y) * brick.z);
    }
    glm::ivec3 coordinates(std::int64_t index) const;
    BrickPlace brick(std::int64_t index) const;
    /// The brick whose clip box holds a position, voxel frame; one between two neighbours belongs
    /// to the farther of them. -1 outside extent(), and for positions that are no numbers.
    std::int64_t brickAt(const glm::dvec3& positionVoxel) const;
    /// The drawn extent in the voxel frame: [0, N-1], less under TRUNCATE.
    Box3d extent() const;

private:
    int brickOnAxis(double position, int axis) const;

    glm::ivec3 _size{0};
    glm::ivec3 _brickSize{0};
    glm::ivec3 _count{0};
    int _overlap = 1;
    PartialBricks _partial = PartialBricks::SHRINK_TO_FIT;
};

} // namespace core
} // namespace osgVolumizer
