#include "SamplingParameters.h"

#include <cmath>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

Status invalid(const char* field, double value, int index = -1)
{
    return {ErrorCode::VALUE_INVALID,
            std::string("SamplingParameters: ") + field + " is " + std::to_string(value) + ".",
            index};
}

} // namespace

Status SamplingParameters::validate() const
{
    for (int i = 0; i < 3; ++i) {
        if (!(periodVoxel[i] > 0.0) || !std::isfinite(periodVoxel[i]))
            return invalid("periodVoxel", periodVoxel[i], i);
        if (!(voxelSize[i] > 0.0) || !std::isfinite(voxelSize[i]))
            return invalid("voxelSize", voxelSize[i], i);
        if (!std::isfinite(outputOrigin[i])) return invalid("outputOrigin", outputOrigin[i], i);
    }
    if (maximumSamples < 1) return invalid("maximumSamples", maximumSamples);
    if (!(curvedTolerance > 0.0) || !std::isfinite(curvedTolerance))
        return invalid("curvedTolerance", curvedTolerance);
    if (mode < SamplingMode::VIEWPORT_ALIGNED || mode > SamplingMode::SPHERICAL)
        return invalid("mode", static_cast<int>(mode));
    if (space < SamplingSpace::VIEW_VOLUME || space > SamplingSpace::PRIMITIVE)
        return invalid("space", static_cast<int>(space));
    return {};
}

} // namespace core
} // namespace osgVolumizer
