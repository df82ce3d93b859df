#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace oracle {

/// Tetrahedra in the object frame, and what fills them.
struct TetraMesh
{
    using Cell = std::array<std::uint32_t, 4>; ///< numbers of its points, in any orientation

    std::vector<glm::dvec3> points;
    std::vector<Cell> cells;
    /// Data values: one per point, linear in each cell, or one per cell.
    std::vector<double> scalars;
    bool scalarsPerCell = false;
    /// Where there are any, one per point: these fill the cells in place of scalars and table.
    /// Straight RGBA, linear in each cell; opacity is that of a layer one opacity unit thick.
    std::vector<glm::dvec4> colors;

    glm::dvec3 corner(const Cell& cell, std::size_t i) const { return points[cell[i]]; }
    /// Positive where the last corner lies to the side of cross(1 - 0, 2 - 0).
    double signedVolume(const Cell& cell) const;
};

} // namespace oracle
} // namespace osgVolumizer
