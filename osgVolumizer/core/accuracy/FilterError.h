#pragma once

#include "PeriodChoice.h"

namespace osgVolumizer {
namespace core {

/// What linear interpolation adds to the root mean square error of a picture whose weights are off
/// by up to `filterWeight`. A bound, from above, but for what random places miss: at each
/// of them values are off by that times their differences along the three axes, all of one sign;
/// the table makes changes of colour and extinction of that; a change of colour shows once, one of
/// extinction over the length of the box's diagonal.
OSGVOLUMIZER_CORE_EXPORT double filterError(const FractionField& field,
                                            const PeriodQuestion& question, double filterWeight);

} // namespace core
} // namespace osgVolumizer
