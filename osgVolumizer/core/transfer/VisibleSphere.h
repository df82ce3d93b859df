#pragma once

#include "../voxels/VoxelData.h"
#include "TransferFunction.h"

#include <glm/vec3.hpp>

#include <optional>

namespace osgVolumizer {
namespace core {

struct BoundingSphere
{
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

/// A sphere around what a table shows of voxels, for a view to frame: nearly all of it, as single
/// samples of noise far off do not count. \param range data values at the ends of the function's
/// domain \param spacing object units between samples \return in object units from the first
/// sample, to about a 32nd of the size; nothing where nothing shows.
OSGVOLUMIZER_CORE_EXPORT std::optional<BoundingSphere>
visibleSphere(const VoxelView& voxels, const ValueRange& range, const TransferFunction& function,
              const glm::dvec3& spacing);

} // namespace core
} // namespace osgVolumizer
