#include "BrickLayout.h"

#include "../Text.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

/// Voxel coordinate that separates two bricks, the second of which starts at sample `start`. In the
/// middle of the shared samples, so that a filter finds its support on both sides; on a sample
/// where it can.
double cutBefore(double start, int overlap)
{
    const int half = (overlap - 1) / 2;
    return overlap == 0 ? start - 0.5 : start + half;
}

std::int64_t bricksOnAxis(std::int64_t size, std::int64_t brick, int overlap, PartialBricks partial)
{
    if (brick >= size) return 1;
    const std::int64_t step = brick - overlap;
    const std::int64_t whole = (size - overlap) / step;
    const bool rest = (size - overlap) % step != 0;
    return rest && partial != PartialBricks::TRUNCATE ? whole + 1 : whole;
}

/// Samples of all bricks along an axis.
double samplesOnAxis(const BrickLayout& layout, int axis)
{
    // One brick after another, each but the first without what it shares.
    const double between = layout.count()[axis] - 1.0;
    const double all = std::min<double>(layout.size()[axis] + between * layout.overlap(),
                                        (between + 1.0) * layout.brickSize()[axis]);
    return layout.partialBricks() == PartialBricks::AVERAGE_UP
               ? (between + 1.0) * layout.brickSize()[axis]
               : all;
}

/// In floating point: the products of three sizes need up to 93 bits.
Status checkExpense(const BrickLayout& layout, const glm::ivec3& brickSize)
{
    double bricks = 1.0, volume = 1.0, held = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        bricks *= layout.count()[axis];
        volume *= layout.size()[axis];
        held *= samplesOnAxis(layout, axis);
    }
    const std::string what = "volume size " + formatTriple(layout.size()) + " in bricks of " +
                             formatTriple(brickSize) + " with overlap " +
                             std::to_string(layout.overlap());
    if (bricks > static_cast<double>(BrickLayout::MAXIMUM_BRICKS))
        return {ErrorCode::TOO_LARGE, what + " makes " + formatNumber(bricks) +
                                          " bricks, more than " +
                                          std::to_string(BrickLayout::MAXIMUM_BRICKS)};
    if (held > BrickLayout::FREE_SAMPLES && held > BrickLayout::MAXIMUM_REPETITION * volume)
        return {ErrorCode::TOO_LARGE, what + " makes bricks that hold " +
                                          formatNumber(std::ceil(held / volume)) +
                                          " times its samples, more than " +
                                          formatNumber(BrickLayout::MAXIMUM_REPETITION) + " times"};
    return {};
}

} // namespace

Result<BrickLayout> BrickLayout::create(const glm::ivec3& size, const glm::ivec3& brickSize,
                                        int overlap, PartialBricks partial)
{
    if (overlap < 0)
        return Status(ErrorCode::VALUE_INVALID,
                      "brick overlap " + std::to_string(overlap) + " is negative");
    if (partial != PartialBricks::SHRINK_TO_FIT && partial != PartialBricks::TRUNCATE &&
        partial != PartialBricks::AVERAGE_UP)
        return Status(ErrorCode::VALUE_INVALID, "partial brick rule " +
                                                    std::to_string(static_cast<int>(partial)) +
                                                    " is unknown");
    BrickLayout layout;
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] < 1)
            return Status(ErrorCode::VALUE_INVALID,
                          "volume size " + formatTriple(size) + " is below 1 on an axis", axis);
        if (brickSize[axis] <= overlap)
            return Status(ErrorCode::VALUE_INVALID,
                          "brick size " + formatTriple(brickSize) +
                              " does not exceed the overlap " + std::to_string(overlap),
                          axis);
        layout._brickSize[axis] = std::min(brickSize[axis], size[axis]);
        layout._count[axis] =
            static_cast<int>(bricksOnAxis(size[axis], layout._brickSize[axis], overlap, partial));
    }
    layout._size = size;
    layout._overlap = overlap;
    layout._partial = partial;
    if (Status status = checkExpense(layout, brickSize); !status.ok()) return status;
    return layout;
}

glm::ivec3 BrickLayout::coordinates(std::int64_t index) const
{
    return {static_cast<int>(index % _count.x), static_cast<int>(index / _count.x % _count.y),
            static_cast<int>(index / _count.x / _count.y)};
}

BrickPlace BrickLayout::brick(std::int64_t index) const
{
    const glm::ivec3 c = coordinates(index);
    BrickPlace place;
    for (int axis = 0; axis < 3; ++axis) {
        const int step = _brickSize[axis] - _overlap;
        const bool last = c[axis] + 1 == _count[axis];
        const int regular = c[axis] * step;
        const int end = std::min(regular + _brickSize[axis], _size[axis]);
        const bool movedBack = _partial == PartialBricks::AVERAGE_UP && last;
        place.samples.min[axis] = movedBack ? _size[axis] - _brickSize[axis] : regular;
        place.samples.max[axis] = end;
        if (_size[axis] == 1) {
            place.clipBox.min[axis] = -0.5;
            place.clipBox.max[axis] = 0.5;
            continue;
        }
        place.clipBox.min[axis] = c[axis] == 0 ? 0.0 : cutBefore(regular, _overlap);
        place.clipBox.max[axis] =
            last ? end - 1.0 : cutBefore(static_cast<double>(regular) + step, _overlap);
    }
    return place;
}

int BrickLayout::brickOnAxis(double position, int axis) const
{
    if (_count[axis] == 1) return 0;
    const double step = _brickSize[axis] - _overlap;
    const double place = std::floor((position - cutBefore(0.0, _overlap)) / step);
    const double brick = std::clamp(place, 0.0, _count[axis] - 1.0);
    // Just before a cut the quotient may have been rounded up to it.
    const bool before = brick > 0.0 && position < cutBefore(brick * step, _overlap);
    return static_cast<int>(brick) - (before ? 1 : 0);
}

std::int64_t BrickLayout::brickAt(const glm::dvec3& positionVoxel) const
{
    const Box3d all = extent();
    glm::ivec3 brick;
    for (int axis = 0; axis < 3; ++axis) {
        const double position = positionVoxel[axis];
        if (!(position >= all.min[axis] && position <= all.max[axis])) return -1;
        brick[axis] = brickOnAxis(position, axis);
    }
    return index(brick);
}

Box3d BrickLayout::extent() const
{
    Box3d box;
    if (brickCount() == 0) return box;
    box.min = brick(0).clipBox.min;
    box.max = brick(brickCount() - 1).clipBox.max;
    return box;
}

} // namespace core
} // namespace osgVolumizer
