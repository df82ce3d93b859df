#pragma once

#include <osgVolumizer/core/geometry/Box.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace oracle {

/// Boxes in a binary tree, halved at the median of their centres, for the question which of them a
/// line may meet.
class BoxTree
{
public:
    BoxTree() = default;
    explicit BoxTree(const std::vector<core::Box3d>& boxes);

    /// Appends the numbers of all boxes that meet origin + t direction for a t in [t0, t1], and of
    /// some that miss it.
    void appendMet(const glm::dvec3& origin, const glm::dvec3& direction, double t0, double t1,
                   std::vector<std::uint32_t>& numbers) const;

private:
    struct Node
    {
        core::Box3d box;
        std::uint32_t first = 0; ///< of `count` entries of _order, or of two children
        std::uint32_t count = 0; ///< 0: not a leaf
    };

    void build(const std::vector<core::Box3d>& boxes, std::size_t node, std::uint32_t first,
               std::uint32_t count);

    std::vector<Node> _nodes;
    std::vector<std::uint32_t> _order; ///< numbers of boxes, those of a leaf together
};

} // namespace oracle
} // namespace osgVolumizer
