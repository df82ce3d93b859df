#pragma once

#include "Volumes.h"

#include <osg/LightSource>

#include <vector>

namespace osgVolumizer {
namespace test {

/// A light in the world frame, for OSG and for the oracle.
struct TestLight
{
    glm::dvec4 position{0, 0, 0, 1};
    glm::dvec3 color{1.0}, ambient{0.0};
    glm::dvec3 attenuation{1.0, 0.0, 0.0};
    glm::dvec3 direction{0, 0, -1};
    double cutoffDegrees = 180.0, exponent = 0.0;
};

osg::ref_ptr<osg::LightSource> makeSource(const TestLight& light, int number, osg::StateSet& lit);

/// A point light with attenuation, a sun, and a spot light.
std::vector<TestLight> someLights();

/// Makes the oracle's volume shade as documented: Blinn-Phong, on central differences, less at the
/// last samples, or of the derivative of what the grid interpolates. `objectToEye` may be any
/// affine map.
void lightOracle(oracle::Volume& volume, std::shared_ptr<oracle::Grid> grid,
                 const std::vector<TestLight>& lights, const support::RenderOptions& options,
                 const VolumeAppearance::Material& material, bool derivative = false);

} // namespace test
} // namespace osgVolumizer
