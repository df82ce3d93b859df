#pragma once

#include "RegionSpans.h"
#include "ValueField.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace picking {

/// A line in the grid frame, by the parameter of a segment.
struct GridLine
{
    glm::dvec3 origin, rate;

    GridLine(const Span& span, const GridReader& grid)
        : origin((span.voxel - grid.offset()) / grid.spacing()),
          rate(span.voxelRate / grid.spacing())
    {
    }
    glm::dvec3 at(double t) const { return origin + t * rate; }
    /// Samples per unit of the parameter.
    double speed() const
    {
        return std::max({std::fabs(rate.x), std::fabs(rate.y), std::fabs(rate.z)});
    }
    /// The cell just beyond a place on the line; see ValueField::cellShift().
    glm::ivec3 cellAfter(double t, double shift) const
    {
        constexpr double AHEAD = 1e-9; // samples
        constexpr double FARTHEST = 1e9;
        const glm::dvec3 ahead = at(t) + AHEAD * glm::sign(rate) + shift;
        return glm::ivec3(glm::floor(glm::clamp(ahead, -FARTHEST, FARTHEST)));
    }
    /// Where the line leaves a box that it is in at t: beyond t in any case.
    double leaves(const core::Box3d& box, double t) const
    {
        double end = HUGE_VAL;
        for (int a = 0; a < 3; ++a) {
            const double face = rate[a] > 0.0 ? box.max[a] : box.min[a];
            if (rate[a] != 0.0) end = std::min(end, (face - origin[a]) / rate[a]);
        }
        const double least = std::max(1e-9 / speed(), 1e-15 * std::fabs(t));
        return std::max(end, t + least);
    }
};

/// A part of a line within one cell.
struct CellPart
{
    double begin, end;     ///< parameters of the segment
    CellValues values;     ///< in the cell
    glm::dvec3 cellOrigin; ///< grid frame: where places in the cell are counted from
    GridLine line;

    double at(double t) const { return values.at(line.at(t) - cellOrigin); }
    /// Steps in which values hardly bend.
    int steps() const
    {
        if (values.interpolation == VolumeAppearance::NEAREST) return 1;
        constexpr double PER_SAMPLE = 8.0;
        return std::max(1, static_cast<int>(std::ceil(PER_SAMPLE * (end - begin) * line.speed())));
    }
};

/// Visits the cells along a span in order, but for those in parts of the grid of which `shows` says
/// that nothing is to be found. `visit(const CellPart&)` returns false to end it; so does this.
template <class Visit>
bool walkCells(ValueField& field, const Span& span, const ValueField::Shows& shows, Visit&& visit)
{
    const GridLine line(span, field.grid());
    if (!(line.speed() > 0.0)) return true; // one voxel all along: no volume
    const double shift = field.cellShift();
    for (double t = span.begin; t < span.end;) {
        const GridReader::Part part = field.partAt(line.cellAfter(t, 0.0), shows);
        const double leave = std::min(span.end, line.leaves(part.box, t));
        while (part.shown && t < leave) {
            const glm::ivec3 cell = line.cellAfter(t, shift);
            const glm::dvec3 low = glm::dvec3(cell) - shift;
            const double next = std::min(leave, line.leaves({low, low + 1.0}, t));
            const CellPart inside{t, next, field.cellValues(cell), low, line};
            if (inside.values.valid && !visit(inside)) return false;
            t = next;
        }
        t = std::max(t, leave);
    }
    return true;
}

} // namespace picking
} // namespace osgVolumizer
