#pragma once

#include <glm/vec3.hpp>

#include <functional>

namespace osgVolumizer {
namespace oracle {

/// Extinction and emission (extinction times straight colour) per unit of the ray parameter.
struct Medium
{
    double extinction = 0.0;
    glm::dvec3 emission{0.0};
};

/// Light gathered so far along a ray, front to back: premultiplied colour, and what still gets
/// through.
struct Light
{
    glm::dvec3 color{0.0};
    double transmittance = 1.0;
};

/// Carries `light` over [t0, t1]: color' = transmittance * emission(t),
/// transmittance' = -transmittance * extinction(t). Gauss's implicit Runge-Kutta method with five
/// nodes (order 10; Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", II.7),
/// which for this system needs no iteration, with bisection where it and the one with three nodes
/// (order 6) differ by more than `tolerance`. Each accepted piece is then off by less than the
/// tolerance, by far so where the medium is smooth.
void integrate(const std::function<Medium(double)>& medium, double t0, double t1, double tolerance,
               Light& light);

} // namespace oracle
} // namespace osgVolumizer
