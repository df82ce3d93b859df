#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Box.h"

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Finds the boxes that a range of space touches. Boxes on a regular or irregular lattice, such as
/// the clip boxes of bricks, are found by their cell; any others in a tree of boxes.
class OSGVOLUMIZER_CORE_EXPORT BoxIndex
{
public:
    /// Refuses (VALUE_INVALID, with the index) boxes that are not finite or have min > max.
    Status build(const std::vector<Box3d>& boxes);

    const std::vector<Box3d>& boxes() const { return _boxes; }
    bool lattice() const { return !_cells.empty(); }

    /// Calls f(boxIndex, needsClipping) for each box that the closed range [min, max] shares points
    /// with; a range without extent along an axis belongs to one box only, by the half-open rule.
    template <class F>
    void visit(const glm::dvec3& min, const glm::dvec3& max, F&& f) const
    {
        if (lattice())
            visitCells(min, max, f);
        else
            visitTree(min, max, f);
    }

private:
    /// Half-open overlap of [min, max] with [low, high) on one axis.
    static bool touches(double min, double max, double low, double high)
    {
        return min < high && (max > low || min >= low);
    }
    static bool inside(const glm::dvec3& min, const glm::dvec3& max, const Box3d& box)
    {
        return min.x >= box.min.x && min.y >= box.min.y && min.z >= box.min.z &&
               max.x <= box.max.x && max.y <= box.max.y && max.z <= box.max.z;
    }
    /// First and last cell of an axis; false where there is none.
    static bool cellRange(const std::vector<double>& splits, double min, double max, int& first,
                          int& last);

    template <class F>
    void visitTree(const glm::dvec3& min, const glm::dvec3& max, F&& f) const
    {
        std::uint32_t stack[2 * MAX_DEPTH + 2];
        int top = 0;
        if (!_nodes.empty()) stack[top++] = 0;
        while (top > 0) {
            const Node& node = _nodes[stack[--top]];
            const Box3d& b = node.bounds;
            if (min.x > b.max.x || min.y > b.max.y || min.z > b.max.z || max.x < b.min.x ||
                max.y < b.min.y || max.z < b.min.z)
                continue;
            if (node.left != 0) {
                stack[top++] = node.right;
                stack[top++] = node.left;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                const Box3d& box = _boxes[_order[i]];
                if (touches(min.x, max.x, box.min.x, box.max.x) &&
                    touches(min.y, max.y, box.min.y, box.max.y) &&
                    touches(min.z, max.z, box.min.z, box.max.z))
                    f(static_cast<int>(_order[i]), !inside(min, max, box));
            }
        }
    }
    template <class F>
    void visitCells(const glm::dvec3& min, const glm::dvec3& max, F&& f) const
    {
        int first[3], last[3];
        for (int a = 0; a < 3; ++a)
            if (!cellRange(_splits[a], min[a], max[a], first[a], last[a])) return;
        const int nx = static_cast<int>(_splits[0].size()) - 1;
        const int ny = static_cast<int>(_splits[1].size()) - 1;
        for (int z = first[2]; z <= last[2]; ++z)
            for (int y = first[1]; y <= last[1]; ++y)
                for (int x = first[0]; x <= last[0]; ++x) {
                    const int box = _cells[(std::size_t(z) * ny + y) * nx + x];
                    if (box >= 0) f(box, !inside(min, max, _boxes[static_cast<std::size_t>(box)]));
                }
    }
    bool buildLattice();
    std::uint32_t buildTree(std::uint32_t begin, std::uint32_t end);

    struct Node
    {
        Box3d bounds;
        std::uint32_t begin = 0, end = 0;  ///< of _order
        std::uint32_t left = 0, right = 0; ///< children; 0 in a leaf
    };
    static constexpr int MAX_DEPTH = 32; ///< halving 2^32 boxes

    std::vector<Box3d> _boxes;
    std::vector<double> _splits[3];
    std::vector<int> _cells; ///< box of each cell, or -1
    std::vector<Node> _nodes;
    std::vector<std::uint32_t> _order;
};

} // namespace core
} // namespace osgVolumizer
