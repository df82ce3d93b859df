#pragma once

#include <limits>

namespace osgVolumizer {
namespace core {

/// The numbers that a property may have, and the words for them in a message.
struct NumberRule
{
    double low, high; ///< both included
    bool orZero;      ///< 0 as well, which stands for none
    const char* expected;

    bool holds(double v) const { return (orZero && v == 0.0) || (v >= low && v <= high); }
};

inline constexpr NumberRule FINITE{std::numeric_limits<double>::lowest(),
                                   std::numeric_limits<double>::max(), false, "a finite number"};
inline constexpr NumberRule NOT_NEGATIVE{0.0, std::numeric_limits<double>::max(), false,
                                         "a number that is not negative"};
/// Shaders, and OSG's bounds, square lengths in 32-bit floats, which hold 1.2e-38 to 3.4e38.
inline constexpr NumberRule LENGTH{1e-18, 1e18, false, "a number from 1e-18 to 1e+18"};
inline constexpr NumberRule LENGTH_OR_NONE{1e-18, 1e18, true, "0 or a number from 1e-18 to 1e+18"};
inline constexpr NumberRule POSITION{-1e18, 1e18, false, "a number from -1e+18 to 1e+18"};
/// From the low to the high end of a range of values: shaders divide by it, and multiply by the
/// entries of a table, in 32-bit floats.
inline constexpr NumberRule RANGE_WIDTH{1e-30, std::numeric_limits<double>::max(), false,
                                        "a finite width of at least 1e-30"};
/// Of what a pick has to find: no ray is ever less than 0 or more than 1, nor exactly 1.
inline constexpr NumberRule PICK_OPACITY{1e-6, 1.0 - 1e-6, false,
                                         "a number from 1e-06 to 0.999999"};
/// Coefficients of reflection: eight lights at the bound do not overflow 16-bit floats, which end
/// at 65504.
inline constexpr NumberRule COEFFICIENT{0.0, 1e3, false, "a number from 0 to 1000"};
/// 32-bit floats tell no angles apart that would matter to a larger one.
inline constexpr NumberRule SHININESS{0.0, 1e7, false, "a number from 0 to 1e+07"};

} // namespace core
} // namespace osgVolumizer
