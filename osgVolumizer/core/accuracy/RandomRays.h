#pragma once

#include "PeriodChoice.h"
#include "RaySamples.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <random>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Uniform lines through the box of a question that show something: as many of each direction as
/// an orthographic view has pixels.
class RandomRays
{
public:
    /// A ray, and what it shows when it is integrated from value to value.
    struct Ray
    {
        RaySamples samples;
        glm::dvec4 light{0.0}; ///< premultiplied
    };

    /// Refers to the field and the question for as long as it lives.
    RandomRays(const FractionField& field, const PeriodQuestion& question, double samplesPerVoxel);

    /// None where nothing shows.
    const std::vector<Ray>& rays() const { return _rays; }
    double samplesPerVoxel() const { return _samplesPerVoxel; }
    /// Twice as many; false where that would be too many, or not so many show something.
    bool doubleRays();

private:
    void grow(std::size_t count);
    void tryRay();
    /// \param ends along the direction, from the point, in voxels
    void sample(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec2& ends);

    const FractionField& _field;
    const PeriodQuestion& _question;
    const double _samplesPerVoxel;
    std::vector<Ray> _rays;
    std::size_t _sampleCount = 0;
    std::mt19937 _random{7};
};

} // namespace core
} // namespace osgVolumizer
