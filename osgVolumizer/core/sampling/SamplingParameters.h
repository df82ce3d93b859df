#pragma once

#include "../Export.h"
#include "../Status.h"

#include <glm/vec3.hpp>

namespace osgVolumizer {

/// Selects the family of surfaces that samples a volume.
enum class SamplingMode : int
{
    VIEWPORT_ALIGNED,
    AXIS_ALIGNED,
    SPHERICAL
};
/// Over which extent the family is spread, and so where its first surface lies.
enum class SamplingSpace : int
{
    VIEW_VOLUME,
    OBJECT,
    PRIMITIVE
};

namespace core {

struct OSGVOLUMIZER_CORE_EXPORT SamplingParameters
{
    SamplingMode mode = SamplingMode::VIEWPORT_ALIGNED;
    SamplingSpace space = SamplingSpace::OBJECT;
    /// Distance between samples along the view, in voxels, per voxel axis; 0.5 meets Nyquist.
    glm::dvec3 periodVoxel{1.0};
    /// No more surfaces than this, ever; the period grows to keep within it.
    int maximumSamples = 4096;
    /// Position units per voxel and axis. Without explicit voxel coordinates positions *are* voxel
    /// coordinates, and this stays 1.
    glm::dvec3 voxelSize{1.0};
    /// Subtracted from positions before they are rounded to float.
    glm::dvec3 outputOrigin{0.0};
    /// SPHERICAL and other curved families: how far a face may lie from its surface, in multiples
    /// of the distance between surfaces.
    double curvedTolerance = 0.1;
    /// Leave out groups of tetrahedra that lie wholly outside the sides of the view volume, or
    /// behind the eye. Surfaces stay where they are.
    bool cullToView = false;

    bool operator==(const SamplingParameters& o) const
    {
        return mode == o.mode && space == o.space && periodVoxel == o.periodVoxel &&
               maximumSamples == o.maximumSamples && voxelSize == o.voxelSize &&
               outputOrigin == o.outputOrigin && curvedTolerance == o.curvedTolerance &&
               cullToView == o.cullToView;
    }
    /// Refuses (VALUE_INVALID) what is not finite, periods, sizes and tolerances <= 0, a bound < 1,
    /// and unknown enums.
    Status validate() const;
};

} // namespace core
} // namespace osgVolumizer
