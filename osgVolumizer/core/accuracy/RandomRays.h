#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "CellRay.h"

#include <glm/mat3x3.hpp>

#include <cstddef>
#include <random>

namespace osgVolumizer {
namespace core {

/// Lines through a box: as many of each direction as an orthographic view has pixels. Directions
/// come in turn, ray i of direction i % DIRECTIONS, but for a few degrees, as within a view: the
/// axes and diagonals of cells, along which rays differ the most from others, and some between
/// them, each forwards and backwards, since what is opaque hides what lies behind. The sequence is
/// always the same.
class OSGVOLUMIZER_CORE_EXPORT RandomRays
{
public:
    static constexpr std::size_t DIRECTIONS = 32;

    /// Expects a box (voxel frame) that is not empty.
    /// \param voxelToUnits a vector of the voxel frame -> opacity units
    /// \param lit whether rays are to have gradients, central differences over a sample's
    /// distance, and a light: half of them that of the eye, others one from anywhere
    RandomRays(const Box3d& box, const glm::dmat3& voxelToUnits, bool nearest, bool lit = false);

    /// The next one; asks the field some times a voxel, and seven times as often where it is lit.
    CellRay next(const FractionField& field);

private:
    glm::dvec3 randomDirection();

    Box3d _box, _samples; ///< a little larger than what has samples, and that
    glm::dmat3 _voxelToUnits;
    bool _nearest, _lit;
    std::mt19937 _random{7};
    std::size_t _count = 0;
};

} // namespace core
} // namespace osgVolumizer
