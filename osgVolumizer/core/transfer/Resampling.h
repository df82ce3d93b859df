#pragma once

#include "TransferFunction.h"

#include <cmath>

namespace osgVolumizer {
namespace core {

/// Selects the places of a table's texels: see TransferFunction::tabulateExtinction.
enum class TexelPlaces : int
{
    ENDS,
    CENTERS
};

/// Largest difference, over [low, high] and the components of premultiplied colour and opacity of
/// one unit, between the function and `count` texels of tabulateExtinction() with linear
/// interpolation between them (constant beyond the outermost). Sampled at the function's points, on
/// both sides of each, and at several places between any two texels: exact to about 5 % of itself.
/// It stops at the first difference above `stopAbove`, and returns that.
OSGVOLUMIZER_CORE_EXPORT double resamplingError(const TransferFunction& function, int count,
                                                double low, double high, TexelPlaces places,
                                                double stopAbove = INFINITY);

struct TexelChoice
{
    int count = 2;
    double error = 0.0; ///< resamplingError() of it; at least this where above the tolerance
};

/// The smallest count tried (2^k, 2^k + 1, and multiples of the function's own steps where its
/// points lie evenly) whose error is at most `tolerance`; where none is, as with a jump, `maximum`.
/// maximum >= 2.
OSGVOLUMIZER_CORE_EXPORT TexelChoice chooseTexelCount(const TransferFunction& function, double low,
                                                      double high, TexelPlaces places,
                                                      double tolerance = 1e-4, int maximum = 4096);

} // namespace core
} // namespace osgVolumizer
