#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "../transfer/ExtinctionTable.h"
#include "../transfer/IntervalTable.h"
#include "CellRay.h"

#include <glm/mat3x3.hpp>

#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace core {

/// How the light along a ray is integrated.
enum class RayRule
{
    MIDPOINTS, ///< equal steps, each with the table's entry at its middle
    INTEGRALS, ///< equal steps, each with the table's mean over the values between its ends
    ADAPTIVE,  ///< the same of steps that adapt to the light that they give: see AdaptiveStep
    CELLS      ///< pieces of cells that end at corners of the table
};

/// How finely a volume is sampled, and by which rule.
struct PeriodChoice
{
    RayRule rule = RayRule::MIDPOINTS;
    /// Length of steps, and the most of a piece's.
    double periodVoxel = 1.0;
    static constexpr double ONE_PIECE = 2.0; ///< longer than any cell
    /// Expected: root mean square over the components of pixels that show something; at the upper
    /// end of what the rays leave uncertain.
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
    double tolerance = 1e-3;              ///< root mean square error
    ExtinctionTable midpoints;            ///< a table without integrals; may be empty
    ExtinctionTable integrals;            ///< the same table with them; may be empty
    const IntervalTable* table = nullptr; ///< the same table, as RayRule::CELLS takes it
    const IntervalTable* exact = nullptr; ///< the same table, cut at all of its points
    bool cells = true;                    ///< whether RayRule::CELLS may be chosen
    double opaqueEnough = 0.0;            ///< what is left of the light where rays end
    const RayShading* shading = nullptr;  ///< null: not lit
};

/// Of choosePeriod(): a choice, and whether more rays would make another one likely.
struct PeriodAnswer
{
    PeriodChoice choice;
    bool wantsMore = false;
};

/// The cheapest rule, with the longest period from 1/16 to 8 voxels (lit and below 3e-4 from 1/32),
/// whose error is within a tolerance; where none is, the one with the least. Found by integrating
/// the first of random rays through the box of what shows something, so it holds whatever the view:
/// the truth of each is what cells give in pieces of an eighth of a voxel, where it is lit a 32nd,
/// half of that for the smallest tolerances, and of the exact table. The same question always has
/// the same answer. Takes about a tenth of a second for a thousand rays of a hundred voxels.
/// Expects both tables and a rule that may be chosen. Where no ray shows anything the longest
/// period.
OSGVOLUMIZER_CORE_EXPORT PeriodAnswer choosePeriod(const PeriodQuestion& question,
                                                   const std::vector<CellRay>& rays,
                                                   std::size_t count);

/// The same for rays of a box (voxel frame), as many as are needed; and filterError().
/// \param voxelToUnits a vector of the voxel frame -> opacity units
OSGVOLUMIZER_CORE_EXPORT PeriodChoice choosePeriod(const PeriodQuestion& question,
                                                   const FractionField& field, const Box3d& box,
                                                   const glm::dmat3& voxelToUnits, bool nearest);

/// How many rays choosePeriod() is to be given first, and at most; and the most cells that they are
/// to pass together.
constexpr std::size_t FIRST_RAYS = 3000, MOST_RAYS = 12000, MOST_RAY_CELLS = 4000000;

} // namespace core
} // namespace osgVolumizer
