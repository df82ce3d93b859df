#include "BrickTree.h"

#include "../Text.h"
#include "../ordering/BrickOrder.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

Status check(const glm::ivec3& size, int levels, int step, int overlap)
{
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] < 1)
            return {ErrorCode::VALUE_INVALID,
                    "volume size " + formatTriple(size) + " is below 1 on an axis", axis};
    if (levels < 1 || levels > BrickTree::MAXIMUM_LEVELS)
        return {ErrorCode::VALUE_INVALID, std::to_string(levels) + " levels, expected 1 to " +
                                              std::to_string(BrickTree::MAXIMUM_LEVELS)};
    if (step < 1)
        return {ErrorCode::VALUE_INVALID,
                "bricks of " + std::to_string(step) + " voxels, expected 1 or more"};
    if (overlap < 1)
        return {ErrorCode::VALUE_INVALID,
                "brick overlap " + std::to_string(overlap) + ", expected 1 or more"};
    return {};
}

} // namespace

glm::ivec3 BrickTree::levelSize(const glm::ivec3& size, int level)
{
    glm::ivec3 result = size;
    for (int i = 0; i < level; ++i)
        result = result / 2 + result % 2;
    return result;
}

int BrickTree::levelsFor(const glm::ivec3& size, int step)
{
    const double gaps = std::max({size.x, size.y, size.z}) - 1.0;
    int levels = 1;
    for (double edge = step; edge < gaps && levels < MAXIMUM_LEVELS; edge *= 2.0)
        ++levels;
    return levels;
}

Result<BrickTree> BrickTree::create(const glm::ivec3& size, int levels, int step, int overlap)
{
    if (Status status = check(size, levels, step, overlap); !status.ok()) return status;
    BrickTree tree;
    tree._size = size;
    tree._step = step;
    tree._overlap = overlap;
    double all = 0.0;
    for (int level = 0; level < levels; ++level) {
        Level made;
        made.size = levelSize(size, level);
        made.first = tree._brickCount;
        const double edge = std::ldexp(step, level);
        double bricks = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            made.count[axis] = std::max(1, static_cast<int>(std::ceil((size[axis] - 1) / edge)));
            bricks *= made.count[axis];
        }
        all += bricks;
        if (all > double(MAXIMUM_BRICKS))
            return Status(ErrorCode::TOO_LARGE, "volume size " + formatTriple(size) +
                                                    " in bricks of " + std::to_string(step) +
                                                    " makes more than " +
                                                    std::to_string(MAXIMUM_BRICKS) + " of them");
        tree._brickCount += std::int64_t(bricks);
        tree._levels.push_back(made);
    }
    return tree;
}

std::int64_t BrickTree::brickCount(int level) const
{
    const glm::ivec3 n = count(level);
    return std::int64_t(n.x) * n.y * n.z;
}

std::int64_t BrickTree::index(int level, const glm::ivec3& c) const
{
    const Level& l = _levels[static_cast<std::size_t>(level)];
    return l.first + c.x + std::int64_t(l.count.x) * (c.y + std::int64_t(l.count.y) * c.z);
}

int BrickTree::levelOf(std::int64_t index) const
{
    int level = levelCount() - 1;
    while (level > 0 && index < _levels[static_cast<std::size_t>(level)].first)
        --level;
    return level;
}

glm::ivec3 BrickTree::coordinatesOf(int level, std::int64_t index) const
{
    const Level& l = _levels[static_cast<std::size_t>(level)];
    const std::int64_t i = index - l.first;
    return {static_cast<int>(i % l.count.x), static_cast<int>(i / l.count.x % l.count.y),
            static_cast<int>(i / l.count.x / l.count.y)};
}

// Where brick `brick` of an axis begins: the same number for all levels.
double BrickTree::cut(int level, int brick, int axis) const
{
    if (_size[axis] == 1) return brick == 0 ? -0.5 : 0.5;
    return std::min(double((std::int64_t(_step) * brick) << level), _size[axis] - 1.0);
}

TreeBrick BrickTree::brick(std::int64_t index) const
{
    TreeBrick brick;
    brick.level = levelOf(index);
    brick.coordinates = coordinatesOf(brick.level, index);
    brick.spacing = double(std::int64_t(1) << brick.level);
    brick.offset = 0.5 * (brick.spacing - 1.0);
    const Level& level = _levels[static_cast<std::size_t>(brick.level)];
    const int margin = (_overlap - 1) / 2;
    const double perSpacing = 1.0 / brick.spacing; // exact: a power of two
    for (int axis = 0; axis < 3; ++axis) {
        const int c = brick.coordinates[axis];
        brick.clipBox.min[axis] = cut(brick.level, c, axis);
        brick.clipBox.max[axis] = cut(brick.level, c + 1, axis);
        const double low = (brick.clipBox.min[axis] - brick.offset) * perSpacing;
        const double high = (brick.clipBox.max[axis] - brick.offset) * perSpacing;
        const int last = level.size[axis] - 1, below = int(low), above = int(high);
        const int first = below - (below > low) - margin; // rounded down, and up
        brick.samples.min[axis] = std::clamp(first, 0, last);
        brick.samples.max[axis] = std::clamp(above + (above < high) + margin, 0, last) + 1;
    }
    return brick;
}

void BrickTree::addFarToNear(int level, const glm::ivec3& first, const glm::ivec3& last,
                             const glm::dvec4& eyeVoxel, std::vector<std::int64_t>& bricks) const
{
    std::vector<double> splits[3];
    for (int axis = 0; axis < 3; ++axis)
        for (int i = first[axis]; i <= last[axis]; ++i)
            splits[axis].push_back(cut(level, i, axis));
    const glm::ivec3 count = last - first;
    std::vector<std::int64_t> order;
    for (std::int64_t i = 0; i < std::int64_t(count.x) * count.y * count.z; ++i)
        order.push_back(i);
    BrickOrder(splits[0], splits[1], splits[2]).sort(eyeVoxel, order);
    for (const std::int64_t i : order)
        bricks.push_back(index(level, first + glm::ivec3(i % count.x, i / count.x % count.y,
                                                         i / (std::int64_t(count.x) * count.y))));
}

std::vector<std::int64_t> BrickTree::roots(const glm::dvec4& eyeVoxel) const
{
    std::vector<std::int64_t> bricks;
    const int top = levelCount() - 1;
    if (top >= 0) addFarToNear(top, glm::ivec3(0), count(top), eyeVoxel, bricks);
    return bricks;
}

std::vector<std::int64_t> BrickTree::children(std::int64_t number, const glm::dvec4& eyeVoxel) const
{
    std::vector<std::int64_t> bricks;
    const int level = levelOf(number);
    if (level == 0) return bricks;
    const glm::ivec3 first = 2 * coordinatesOf(level, number);
    const glm::ivec3 all = count(level - 1);
    // What BrickOrder says of a lattice of two by two by two: per axis, the one behind the split.
    int order[3][2], counts[3];
    for (int axis = 0; axis < 3; ++axis) {
        counts[axis] = first[axis] + 1 < all[axis] ? 2 : 1;
        const double eye = eyeVoxel.w == 0.0 ? eyeVoxel[axis] : eyeVoxel[axis] / eyeVoxel.w;
        const double split = eyeVoxel.w == 0.0 ? 0.0 : cut(level - 1, first[axis] + 1, axis);
        const bool beyond = eyeVoxel.w == 0.0 ? eye > split : eye >= split;
        order[axis][0] = first[axis] + (counts[axis] == 2 && !beyond);
        order[axis][1] = first[axis] + int(beyond);
    }
    bricks.reserve(8);
    for (int z = 0; z < counts[2]; ++z)
        for (int y = 0; y < counts[1]; ++y)
            for (int x = 0; x < counts[0]; ++x)
                bricks.push_back(index(level - 1, {order[0][x], order[1][y], order[2][z]}));
    return bricks;
}

Box3i samplesBelow(const BrickTree& tree, const TreeBrick& brick)
{
    Box3i box = brick.samples;
    for (int axis = 0; axis < 3; ++axis)
        for (int* end : {&box.min[axis], &box.max[axis]})
            *end = static_cast<int>(
                std::min<std::int64_t>(std::int64_t(*end) << brick.level, tree.size()[axis]));
    return box;
}

} // namespace core
} // namespace osgVolumizer
