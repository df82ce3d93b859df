#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "../transfer/IntervalTable.h"
#include "CellRay.h"

#include <glm/mat3x3.hpp>

namespace osgVolumizer {
namespace core {

/// What linear interpolation adds to the root mean square error of a picture whose weights are off
/// by up to `filterWeight`. A bound, from above, but for what random places miss: at each
/// of them values are off by that times their differences along the three axes, all of one sign;
/// the table makes changes of colour and extinction of that; a change of colour shows once, one of
/// extinction over the length of the box's diagonal.
/// \param box voxel frame; of what shows something
/// \param voxelToUnits a vector of the voxel frame -> opacity units
OSGVOLUMIZER_CORE_EXPORT double filterError(const FractionField& field, const Box3d& box,
                                            const glm::dmat3& voxelToUnits,
                                            const IntervalTable& table, double filterWeight);

} // namespace core
} // namespace osgVolumizer
