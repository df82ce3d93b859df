#pragma once

#include <vector>

namespace osgVolumizer {
namespace oracle {

/// Appends the t in (t0, t1) where the cubic through f[n] at t0 + n (t1-t0)/3 takes one of the
/// values, which ascend. By Bernstein coefficients and bisection (Lane and Riesenfeld, "Bounds on a
/// polynomial", BIT 21, 1981) down to where these ascend or descend, and Newton's method there: no
/// root is missed; one of even order may come several times.
void appendCubicRoots(const double f[4], const std::vector<double>& values, double t0, double t1,
                      std::vector<double>& roots);

} // namespace oracle
} // namespace osgVolumizer
