#include "Placement.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace osgVolumizer {
namespace io {

Status place(VoxelSource::Description& description, const glm::dmat3& steps,
             const glm::dvec3& position)
{
    constexpr double FLAT = 1e-6; // volume of the cell of unit vectors
    const glm::dvec3 lengths(glm::length(steps[0]), glm::length(steps[1]), glm::length(steps[2]));
    glm::dmat3 axes(1.0);
    for (int i = 0; i < 3; ++i)
        axes[i] = steps[i] / lengths[i];
    if (!(std::abs(glm::determinant(axes)) > FLAT) ||
        !std::isfinite(position.x + position.y + position.z))
        return {ErrorCode::VALUE_INVALID, "the axes of its voxels span no volume"};
    description.spacing = lengths;
    description.axes = axes;
    description.origin = glm::inverse(axes) * position;
    return {};
}

glm::dvec3 placeOf(const VoxelSource::Description& d, const glm::dvec3& voxel)
{
    return d.axes * (d.origin + d.spacing * voxel);
}

} // namespace io
} // namespace osgVolumizer
