#pragma once

#include "GridSource.h"
#include "Samples.h"
#include "TreeVisit.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/core/voxels/BrickTree.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>
#include <vector>

namespace osgVolumizer {
namespace vdb {

/// What is known of voxels of which one sample is made: of all but those of the background's value,
/// which may be so large that others vanish beside it.
struct Sum
{
    double finite = 0.0, of = 0.0; ///< the sum of those that are finite, and how many
    double voxels = 0.0;           ///< all

    void add(double value, double times)
    {
        voxels += times;
        if (!std::isfinite(value)) return;
        finite += times * value;
        of += times;
    }
    void add(const Sum& sum)
    {
        finite += sum.finite;
        of += sum.of;
        voxels += sum.voxels;
    }
    /// The mean of the finite ones of `all` voxels, of which those not added have the background's
    /// value; NaN where there are none.
    double meanWith(double background, double all) const
    {
        const double rest = std::isfinite(background) ? all - voxels : 0.0;
        if (of + rest == 0.0) return std::numeric_limits<double>::quiet_NaN();
        if (of == 0.0) return background;
        const double mean = finite / of;
        return rest == 0.0 ? mean : mean + (background - mean) * (rest / (of + rest));
    }
};

/// The voxels of a grid as numbers that are an `Out` in memory each (see Samples.h). Threads read
/// side by side: nobody changes the tree. What no node of it has takes no memory but that of the
/// region asked for, and its range is known without reading.
///
/// Where all of the volume took more than half of what paged voxels may take in memory it has
/// coarser levels: floats are means of all finite ones that they stand for, integers, which may be
/// labels, the voxel in the middle.
template <class Grid, class Out>
class TreeSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, TreeSource);

    TreeSource() = default;
    /// Shares the tree.
    TreeSource(const TreeSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op), _show(o._show), _grid(o._grid), _leaves(o._leaves),
          _levelCount(o._levelCount)
    {
    }
    explicit TreeSource(const GridToShow& show)
        : _show(show), _grid(openvdb::gridConstPtrCast<Grid>(show.grid))
    {
        _show.description.type = voxelTypeOf<Out>();
        auto leaves = std::make_shared<Leaves>();
        for (auto leaf = _grid->tree().cbeginLeaf(); leaf; ++leaf)
            leaves->emplace(&*leaf, summaryOf(*leaf, leaf->getNodeBoundingBox()));
        _leaves = leaves;
        if (_show.description.sizeInBytes() > getPagingBudget().memoryBytes / 2)
            _levelCount = core::BrickTree::levelsFor(_show.description.size, pageSize());
    }

    Description describe() const override { return _show.description; }
    int levelCount() const override { return _levelCount; }

    Status read(const core::Box3i& region, void* destination) const override
    {
        if (region.empty()) return {};
        if (Status status = check(0, region); !status.ok()) return status;
        openvdb::tools::Dense<Out, openvdb::tools::LayoutXYZ> dense(boxOf(0, region),
                                                                    static_cast<Out*>(destination));
        _grid->tree().root().copyToDense(dense.bbox(), dense);
        return {};
    }

    Status readLevel(int level, const core::Box3i& region, void* destination) const override
    {
        if (level == 0) return read(region, destination);
        if (level < 0 || level >= _levelCount)
            return VoxelSource::readLevel(std::max(level, 1), region, destination);
        if (region.empty()) return {};
        if (Status status = check(level, region); !status.ok()) return status;
        if constexpr (isFloat(voxelTypeOf<Out>()))
            readMeans(level, region, static_cast<Out*>(destination));
        else
            readMiddles(level, region, static_cast<Out*>(destination));
        return {};
    }

    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override
    {
        return levelRange(0, region);
    }

    std::optional<std::pair<double, double>> levelRange(int level,
                                                        const core::Box3i& region) const override
    {
        if (!_grid || level < 0 || level >= _levelCount || region.empty() ||
            !check(level, region).ok())
            return std::nullopt;
        core::ValueRange range;
        const auto add = [&range](double v) {
            if (std::isfinite(v)) range.expand({v, v});
        };
        const bool all = visitTree(
            _grid->tree(), boxOf(level, region),
            [&](const Leaf& leaf, const openvdb::CoordBBox& part) {
                const bool whole = part == leaf.getNodeBoundingBox();
                range.expand(whole ? _leaves->at(&leaf).range : summaryOf(leaf, part).range);
            },
            [&](const Value& value, const openvdb::CoordBBox&) { add(number(value)); });
        if (!all) add(number(_grid->background()));
        return std::pair(range.low, range.high);
    }

protected:
    ~TreeSource() override = default;

private:
    using Value = typename Grid::ValueType;
    using Leaf = typename Grid::TreeType::LeafNodeType;
    struct Summary
    {
        core::ValueRange range; ///< of values that are finite
        Sum sum;
    };
    using Leaves = std::unordered_map<const Leaf*, Summary>;

    static constexpr bool isFloat(VoxelType type)
    {
        return type == VoxelType::HALF || type == VoxelType::FLOAT32 || type == VoxelType::FLOAT64;
    }
    static double number(const Value& value) { return static_cast<double>(Out(value)); }

    template <class Function>
    static void forEach(const openvdb::CoordBBox& box, const Function& function)
    {
        openvdb::Coord at;
        for (at.z() = box.min().z(); at.z() <= box.max().z(); ++at.z())
            for (at.y() = box.min().y(); at.y() <= box.max().y(); ++at.y())
                for (at.x() = box.min().x(); at.x() <= box.max().x(); ++at.x())
                    function(at);
    }
    Summary summaryOf(const Leaf& leaf, const openvdb::CoordBBox& part) const
    {
        const double background = number(_grid->background());
        Summary summary;
        forEach(part, [&](const openvdb::Coord& at) {
            const double v = number(leaf.getValue(at));
            if (v != background) summary.sum.add(v, 1.0);
            if (std::isfinite(v)) summary.range.expand({v, v});
        });
        return summary;
    }

    Status check(int level, const core::Box3i& region) const
    {
        if (!_grid) return {ErrorCode::VALUE_INVALID, "the voxel source has no grid"};
        return checkRegion(region, core::BrickTree::levelSize(_show.description.size, level));
    }
    /// The voxels of the grid that a region of a level stands for.
    openvdb::CoordBBox boxOf(int level, const core::Box3i& region) const
    {
        openvdb::CoordBBox box;
        for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t first = _show.box.min()[axis];
            box.min()[axis] = int(first + (std::int64_t(region.min[axis]) << level));
            box.max()[axis] = int(std::min<std::int64_t>(
                first + (std::int64_t(region.max[axis]) << level) - 1, _show.box.max()[axis]));
        }
        return box;
    }

    void readMeans(int level, const core::Box3i& region, Out* destination) const;
    void readMiddles(int level, const core::Box3i& region, Out* destination) const;

    GridToShow _show;
    typename Grid::ConstPtr _grid;
    std::shared_ptr<const Leaves> _leaves; ///< what is known of all 512 voxels of each
    int _levelCount = 1;
};

template <class Grid, class Out>
void TreeSource<Grid, Out>::readMeans(int level, const core::Box3i& region, Out* destination) const
{
    using openvdb::Coord;
    using openvdb::CoordBBox;
    const glm::ivec3 size = region.size();
    std::vector<Sum> sums(std::size_t(size.x) * size.y * size.z);
    const Coord origin = _show.box.min();
    const auto indexOf = [&](const Coord& at) { // of the level, in the region
        const auto along = [&](int axis) {
            return std::size_t(((std::int64_t(at[axis]) - origin[axis]) >> level) -
                               region.min[axis]);
        };
        return (along(2) * size.y + along(1)) * size.x + along(0);
    };
    const double background = number(_grid->background());
    const auto addTile = [&](const Value& value, const CoordBBox& part) {
        const double v = number(value);
        if (v == background) return;
        // Piece by piece of what is one sample of the level.
        Coord at, end;
        const auto endOf = [&](int axis) {
            const std::int64_t within = (std::int64_t(at[axis]) - origin[axis]) >> level;
            return int(std::min<std::int64_t>(origin[axis] + ((within + 1) << level) - 1,
                                              part.max()[axis]));
        };
        for (at.z() = part.min().z(); at.z() <= part.max().z(); at.z() = end.z() + 1) {
            end.z() = endOf(2);
            for (at.y() = part.min().y(); at.y() <= part.max().y(); at.y() = end.y() + 1) {
                end.y() = endOf(1);
                for (at.x() = part.min().x(); at.x() <= part.max().x(); at.x() = end.x() + 1) {
                    end.x() = endOf(0);
                    sums[indexOf(at)].add(v, double(CoordBBox(at, end).volume()));
                }
            }
        }
    };
    const auto addLeaf = [&](const Leaf& leaf, const CoordBBox& part) {
        const std::size_t first = indexOf(part.min());
        if (part == leaf.getNodeBoundingBox() && first == indexOf(part.max()))
            sums[first].add(_leaves->at(&leaf).sum);
        else
            forEach(part, [&](const Coord& at) {
                const double v = number(leaf.getValue(at));
                if (v != background) sums[indexOf(at)].add(v, 1.0);
            });
    };
    visitTree(_grid->tree(), boxOf(level, region), addLeaf, addTile);
    // The last sample of an axis may stand for fewer voxels.
    const auto voxels = [&](int axis, int i) {
        const std::int64_t from = std::int64_t(i) << level;
        return double(
            std::min<std::int64_t>(std::int64_t(1) << level, _show.description.size[axis] - from));
    };
    const Sum* sum = sums.data();
    for (int z = region.min.z; z < region.max.z; ++z)
        for (int y = region.min.y; y < region.max.y; ++y)
            for (int x = region.min.x; x < region.max.x; ++x)
                *destination++ =
                    Out((sum++)->meanWith(background, voxels(0, x) * voxels(1, y) * voxels(2, z)));
}

template <class Grid, class Out>
void TreeSource<Grid, Out>::readMiddles(int level, const core::Box3i& region,
                                        Out* destination) const
{
    const auto tree = _grid->getConstUnsafeAccessor(); // of this call alone
    const auto at = [&](int i, int axis) {
        const std::int64_t place = (std::int64_t(i) << level) + (std::int64_t(1) << (level - 1));
        return int(_show.box.min()[axis] +
                   std::min<std::int64_t>(place, _show.description.size[axis] - 1));
    };
    for (int z = region.min.z; z < region.max.z; ++z)
        for (int y = region.min.y; y < region.max.y; ++y)
            for (int x = region.min.x; x < region.max.x; ++x)
                *destination++ = Out(tree.getValue({at(x, 0), at(y, 1), at(z, 2)}));
}

} // namespace vdb
} // namespace osgVolumizer
