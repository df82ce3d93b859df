#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Box.h"

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Finds the boxes that a range of space touches. Boxes on a regular or irregular lattice, such as
/// the clip boxes of bricks, are found by their cell; any others by a test of each.
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
            visitAll(min, max, f);
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
    void visitAll(const glm::dvec3& min, const glm::dvec3& max, F&& f) const
    {
        for (std::size_t i = 0; i < _boxes.size(); ++i) {
            const Box3d& b = _boxes[i];
            if (touches(min.x, max.x, b.min.x, b.max.x) &&
                touches(min.y, max.y, b.min.y, b.max.y) && touches(min.z, max.z, b.min.z, b.max.z))
                f(static_cast<int>(i), !inside(min, max, b));
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
                    const int box = _cells[static_cast<std::size_t>((z * ny + y) * nx + x)];
                    if (box >= 0) f(box, !inside(min, max, _boxes[static_cast<std::size_t>(box)]));
                }
    }
    bool buildLattice();

    std::vector<Box3d> _boxes;
    std::vector<double> _splits[3];
    std::vector<int> _cells; ///< box of each cell, or -1
};

} // namespace core
} // namespace osgVolumizer
