#pragma once

#include "../Export.h"
#include "TransferFunction.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A transfer function cut at its corners: between two of them it is smooth, and looked up from
/// that side alone, so that whoever splits a ray where its value passes a corner integrates smooth
/// functions.
struct OSGVOLUMIZER_CORE_EXPORT IntervalTable
{
    /// First two texels for each interval, from low values to high ones without gaps: its first
    /// and last value (the first of all and the last of all far away), the index of its first
    /// entry, and entries per value; its largest extinction. Then entries, equally spaced in each
    /// interval with one at either end, and one more: colour, and extinction in bits (-log2 of
    /// transmittance) per opacity unit, both to be interpolated linearly.
    std::vector<glm::vec4> texels;
    int intervals = 0;

    static constexpr float FAR_AWAY = 1e30f;

    bool empty() const { return intervals == 0; }
    /// The interval that holds a value; of two at a corner the upper one.
    int find(double value) const;
    /// Colour and extinction at a value, which is held to the interval.
    glm::dvec4 at(int interval, double value) const;
    /// An interval's first texel.
    const glm::vec4& of(int interval) const { return texels[2 * std::size_t(interval)]; }
    /// Its largest extinction, bits per opacity unit.
    double largestExtinction(int interval) const
    {
        return double(texels[2 * std::size_t(interval) + 1].x);
    }
};

/// Corners are jumps, and kinks where the slope of opacity, or of opacity times colour, changes by
/// `sharpness` or more: per unit of the value, and relative to what is let through. 0: all points.
/// Between entries extinction and colour are off by less than 1e-6, extinction relative to the
/// largest of the interval, or by what 4096 entries an interval leave.
OSGVOLUMIZER_CORE_EXPORT IntervalTable makeIntervalTable(const TransferFunction& function,
                                                         double sharpness);

} // namespace core
} // namespace osgVolumizer
