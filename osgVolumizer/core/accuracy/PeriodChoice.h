#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "../transfer/ExtinctionTable.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <functional>

namespace osgVolumizer {
namespace core {

/// How finely a volume is sampled, and with which kind of table.
struct PeriodChoice
{
    double periodVoxel = 1.0;
    bool integrals = false;
    /// Expected: root mean square over the components of pixels that show something.
    double error = 0.0;
    /// What weights of interpolation that are off by FILTER_WEIGHT would add, see filterError(); in
    /// proportion for others.
    double filterError = 0.0;
    static constexpr double FILTER_WEIGHT = 1.0 / 512.0; ///< as of texture units of 8 bits

    /// Whether weights that are off by so much keep a tolerance, together with the period.
    bool permits(double filterWeight, double tolerance) const;
};

/// What a choice is made for.
struct PeriodQuestion
{
    double tolerance = 1e-3;   ///< root mean square error
    ExtinctionTable midpoints; ///< a table without integrals; may be empty
    ExtinctionTable integrals; ///< the same table with them; may be empty, but not both
    glm::dmat3 voxelToUnits{1.0};
    Box3d box; ///< voxel frame; of what shows something
};

/// The value at a position of the voxel frame, as a fraction of the voxels' range; NaN where
/// nothing shows.
using FractionField = std::function<double(const glm::dvec3& positionVoxel)>;

/// The longest period from 1/16 to 16 voxels, and the cheaper table, whose error is within a
/// tolerance. Found by marching random rays through the values, so it holds whatever the view: they
/// are sampled once, much more finely than any choice, and then integrated with periods of a
/// geometric sequence, and compared. The same question always has the same answer. Calls `field`
/// some millions of times. The default choice where the box is empty.
OSGVOLUMIZER_CORE_EXPORT PeriodChoice choosePeriod(const FractionField& field,
                                                   const PeriodQuestion& question);

} // namespace core
} // namespace osgVolumizer
