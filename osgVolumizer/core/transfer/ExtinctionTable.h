#pragma once

#include "../Export.h"

#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace core {

/// A lookup table in memory that is read at the nearest entry. Entry i of count is at i/(count-1)
/// of the voxels' range: colour, and extinction in bits per opacity unit. Where there are
/// integrals, count + 1 texels follow: the integral of extinction times colour, and of extinction,
/// up to half an entry before each, in entries, so that the difference of two over the difference
/// of their indices is a mean. Refers to texels that others own.
struct OSGVOLUMIZER_CORE_EXPORT ExtinctionTable
{
    const glm::vec4* texels = nullptr; ///< count, or 2 * count + 1 with integrals
    int count = 0;                     ///< entries
    bool integrals = false;

    bool empty() const { return count == 0; }
    /// Colour and extinction at a fraction of the range; nothing where that is NaN.
    glm::dvec4 at(double fraction) const;
    /// Their means over a run of values from one fraction of the range to another: of colour,
    /// weighted by extinction. Where one of the fractions is NaN, at() the other one. Expects
    /// integrals.
    glm::dvec4 mean(double from, double to) const;

private:
    int nearest(double fraction) const;
};

} // namespace core
} // namespace osgVolumizer
