#pragma once

#include "../draw/VolumeLook.h"

#include "../../core/ordering/CoverMask.h"
#include "../../core/voxels/BrickTree.h"
#include "../../core/voxels/VoxelData.h"

#include <osg/Vec2d>

#include <functional>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace osgVolumizer {
namespace render {

/// How far a ray gets in what a table shows, in voxels at most, until what is left of the light
/// does not count.
class OpaqueDepth
{
public:
    /// \param range data values at the ends of the table
    OpaqueDepth(const VolumeLook& look, const osg::Vec2d& range);

    /// In values between two, as the table is read: at the nearest entry, perhaps.
    double of(const core::ValueRange& values) const;
    /// In the most opaque values that there are.
    double least() const;

private:
    double depth(double opacity) const;

    LookupTable::Function _function;
    osg::Vec2d _range;
    double _voxelsPerUnit; ///< of length, at most
    double _entry;         ///< fraction of the range from one entry to the next
};

/// Finds the pages of a tree that lie behind opaque ones of the same tree, on every ray.
class CoveredPages
{
public:
    struct Page
    {
        core::TreeBrick brick;
        core::Box3d box;                   ///< voxel frame; what is drawn of it
        std::optional<double> opaqueDepth; ///< voxels; none where its values are not known
        bool splits = false;               ///< whether finer pages may be drawn instead
    };
    /// A page of a number; none where nothing of it is drawn.
    using Describe = std::function<std::optional<Page>(std::int64_t page)>;

    /// \param most pages that are looked at: those that come first
    CoveredPages(const core::BrickTree& tree, const glm::dvec4& eyeVoxel, core::CoverMask mask,
                 std::int64_t most, Describe describe);

    /// The coarsest pages that are covered, of those that may be drawn.
    std::unordered_set<std::int64_t> find();

private:
    void visit(const std::vector<std::int64_t>& farToNear);
    void visit(std::int64_t page);
    void cover(const Page& page);
    const std::optional<Page>& describe(std::int64_t page);

    const core::BrickTree& _tree;
    const glm::dvec4 _eye;
    core::CoverMask _mask;
    std::int64_t _left; ///< of the pages that may be looked at
    const Describe _describe;
    std::unordered_map<std::int64_t, std::optional<Page>> _known;
    std::unordered_set<std::int64_t> _covered;
};

} // namespace render
} // namespace osgVolumizer
