#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "CellRay.h"

#include <glm/mat3x3.hpp>

#include <random>

namespace osgVolumizer {
namespace core {

/// Uniform lines through a box: as many of each direction as an orthographic view has pixels. The
/// sequence is always the same.
class OSGVOLUMIZER_CORE_EXPORT RandomRays
{
public:
    /// Expects a box (voxel frame) that is not empty.
    /// \param voxelToUnits a vector of the voxel frame -> opacity units
    RandomRays(const Box3d& box, const glm::dmat3& voxelToUnits, bool nearest);

    /// The next one; asks the field some times a voxel.
    CellRay next(const FractionField& field);

private:
    Box3d _box;
    glm::dmat3 _voxelToUnits;
    bool _nearest;
    std::mt19937 _random{7};
};

} // namespace core
} // namespace osgVolumizer
