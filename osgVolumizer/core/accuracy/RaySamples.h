#pragma once

#include "../Export.h"
#include "../transfer/ExtinctionTable.h"

#include <glm/vec4.hpp>

#include <vector>

namespace osgVolumizer {
namespace core {

/// Values along a ray at equal distances, both ends included, between which they are interpolated
/// linearly: the ray is sampled once, and then integrated in any number of ways.
struct OSGVOLUMIZER_CORE_EXPORT RaySamples
{
    std::vector<float> values; ///< fractions of the voxels' range, two at least; NaN shows nothing
    double unitsPerInterval = 1.0; ///< opacity units from one value to the next

    /// Length of the ray in intervals.
    double length() const { return static_cast<double>(values.size()) - 1.0; }
    /// The value at a place from 0 to length(); the nearer one where either neighbour is NaN.
    double at(double place) const;

    /// Premultiplied colour and opacity of the ray from its first value to its last, composited
    /// from steps of about a period (given in intervals) as the renderer does: each takes the
    /// table's entry at its middle, or with integrals the mean over the values between its ends.
    /// Ends early where less than 3e-5 of the light passes. The midpoint rule is of second order.
    glm::dvec4 integrate(const ExtinctionTable& table, double periodIntervals) const;
};

} // namespace core
} // namespace osgVolumizer
