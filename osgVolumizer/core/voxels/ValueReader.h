#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "BrickLayout.h"
#include "VoxelData.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <unordered_map>

namespace osgVolumizer {
namespace core {

/// Reads values of one component at any position of a volume that is cut into bricks. Bricks are
/// loaded when a position first falls into them, and kept for as long as the reader lives. For one
/// thread.
class OSGVOLUMIZER_CORE_EXPORT ValueReader
{
public:
    /// How values between samples are interpolated.
    enum Interpolation : int
    {
        NEAREST,
        LINEAR ///< trilinearly
    };
    /// The samples of a brick, of the size that the layout gives it. Without data where there are
    /// none: nothing is known of the brick.
    struct Brick
    {
        VoxelView view;
        std::shared_ptr<const void> owner; ///< keeps the samples in memory; may be null
    };
    using Load = std::function<Brick(std::int64_t brick)>;

    /// \param load called once for each brick that is needed
    /// \param component that is read, below those of the bricks
    /// \param holeValue the value where samples that count are NaN or infinite
    ValueReader(const BrickLayout& layout, Load load, Interpolation interpolation,
                int component = 0, double holeValue = std::numeric_limits<double>::quiet_NaN());

    /// The value at a position, voxel frame, in data units. NaN outside the layout's extent and in
    /// bricks without samples. A position between two bricks is read from the farther one; beyond
    /// the samples of a brick (without overlap) the outermost ones continue. O(1).
    double value(const glm::dvec3& positionVoxel);
    /// The change of the value per voxel, by differences between the values one voxel to either
    /// side, less where only one of them is known: with LINEAR, what central differences at the
    /// samples become when they are interpolated. NaN where value() is, and where neither is known.
    glm::dvec3 gradient(const glm::dvec3& positionVoxel);

private:
    using Read = double (*)(const VoxelView& view, int component, const glm::ivec3& corner,
                            const glm::dvec3& fraction);
    struct Loaded
    {
        Brick brick;
        Box3d box; ///< half-open: positions that are read from it
        glm::dvec3 first{0.0};
        Read read = nullptr; ///< null without samples
    };

    const Loaded* find(const glm::dvec3& positionVoxel);
    Loaded load(std::int64_t brick) const;
    double difference(const glm::dvec3& positionVoxel, int axis, double here);

    BrickLayout _layout;
    Load _load;
    Interpolation _interpolation;
    int _component;
    double _holeValue;
    Box3d _extent;
    std::unordered_map<std::int64_t, Loaded> _bricks;
    const Loaded* _last = nullptr; ///< neighbouring positions mostly have one brick
};

} // namespace core
} // namespace osgVolumizer
