#pragma once

#include <osgVolumizer/core/transfer/TransferFunction.h>

#include <glm/vec3.hpp>

#include <cmath>
#include <vector>

namespace osgVolumizer {
namespace bench {

using TablePoints = std::vector<core::TransferFunction::Point>;

/// Colours and opacity without kinks that matter: 65 points of smooth functions.
inline TablePoints smoothTable(double opacity)
{
    TablePoints points;
    for (int i = 0; i <= 64; ++i) {
        const double v = i / 64.0, s = v * v * (3.0 - 2.0 * v);
        points.push_back({v, {s, 0.5 + 0.4 * std::sin(3.0 * v), 1.0 - 0.8 * s, opacity * s}});
    }
    return points;
}

/// One colour, and an extinction proportional to the value, to millionths of the largest: what is
/// looked up before interpolation is then what is looked up after it.
inline TablePoints greyTable(double extinction)
{
    TablePoints points;
    for (int i = 0; i <= 64; ++i)
        points.push_back({i / 64.0, {0.8, 0.8, 0.8, 1.0 - std::exp(-extinction * i / 64.0)}});
    return points;
}

/// A transparent background with one opaque peak, 1/32 of the range wide.
inline TablePoints peakTable()
{
    const glm::dvec3 blue(0.2, 0.4, 0.9), gold(1.0, 0.8, 0.2);
    return {{0.0, {blue, 0.0}},
            {0.5, {blue, 0.0}},
            {0.515625, {gold, 0.8}},
            {0.53125, {blue, 0.0}},
            {1.0, {blue, 0.0}}};
}

} // namespace bench
} // namespace osgVolumizer
