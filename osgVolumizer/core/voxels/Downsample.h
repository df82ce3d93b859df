#pragma once

#include "../Export.h"
#include "VoxelType.h"

#include <glm/vec3.hpp>

namespace osgVolumizer {
namespace core {

/// What a sample of a coarser level stands for.
enum class LevelRule : int
{
    MEAN, ///< of eight samples, but for NaN; colours weighted by alpha
    MODE  ///< the most frequent of eight samples, the lowest of several: for labels
};

/// Samples of the next coarser level, tightly packed: sample (i,j,k) from those at (2i..2i+1, ...),
/// as far as there are any.
/// \param size of `fine`, samples per axis, each >= 1; of `coarse`: half of it, rounded up
/// \param components 1, or 4 for RGBA with straight alpha
OSGVOLUMIZER_CORE_EXPORT void downsample(const void* fine, const glm::ivec3& size, VoxelType type,
                                         int components, LevelRule rule, void* coarse);

} // namespace core
} // namespace osgVolumizer
