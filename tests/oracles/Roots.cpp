#include "Roots.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace oracle {
namespace {

// The root on [0, 1] of a cubic that only ascends or only descends, of values of either sign at the
// ends: Newton's steps, or halves of what encloses the root where those leave it.
double onlyRoot(const double b[4])
{
    const double c1 = 3.0 * (b[1] - b[0]), c2 = 3.0 * (b[2] - 2.0 * b[1] + b[0]);
    const double c3 = b[3] - b[0] + 3.0 * (b[1] - b[2]);
    const bool ascends = b[3] > b[0];
    double low = 0.0, high = 1.0, u = b[0] / (b[0] - b[3]);
    for (int i = 0; i < 60; ++i) {
        const double f = ((c3 * u + c2) * u + c1) * u + b[0];
        if (f == 0.0) break;
        ((f < 0.0) == ascends ? low : high) = u;
        const double newton = u - f / ((3.0 * c3 * u + 2.0 * c2) * u + c1);
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        const double step = std::abs(next - u);
        u = next;
        if (step < 1e-16) break;
    }
    return u;
}

// Bernstein coefficients over [t0, t1]; what is smaller than `noise` is taken for a root.
void bisect(const double b[4], double t0, double t1, double noise, std::vector<double>& roots)
{
    const auto bounds = std::minmax({b[0], b[1], b[2], b[3]});
    if (bounds.first > 0.0 || bounds.second < 0.0) return;
    const double middle = 0.5 * (t0 + t1);
    const bool flat = bounds.first >= -noise && bounds.second <= noise;
    if (flat || middle <= t0 || middle >= t1) {
        roots.push_back(middle);
        return;
    }
    const bool ascends = b[0] < b[1] && b[1] < b[2] && b[2] < b[3];
    if (ascends || (b[0] > b[1] && b[1] > b[2] && b[2] > b[3])) {
        roots.push_back(t0 + (t1 - t0) * onlyRoot(b));
        return;
    }
    const double b01 = 0.5 * (b[0] + b[1]), b12 = 0.5 * (b[1] + b[2]), b23 = 0.5 * (b[2] + b[3]);
    const double b012 = 0.5 * (b01 + b12), b123 = 0.5 * (b12 + b23);
    const double center = 0.5 * (b012 + b123);
    const double left[4] = {b[0], b01, b012, center}, right[4] = {center, b123, b23, b[3]};
    bisect(left, t0, middle, noise, roots);
    bisect(right, middle, t1, noise, roots);
}

} // namespace

void appendCubicRoots(const double f[4], const std::vector<double>& values, double t0, double t1,
                      std::vector<double>& roots)
{
    const double b[4] = {f[0], (-5.0 * f[0] + 18.0 * f[1] - 9.0 * f[2] + 2.0 * f[3]) / 6.0,
                         (2.0 * f[0] - 9.0 * f[1] + 18.0 * f[2] - 5.0 * f[3]) / 6.0, f[3]};
    const auto bounds = std::minmax({b[0], b[1], b[2], b[3]});
    if (bounds.first == bounds.second) return; // constant: no kink is crossed
    const double noise = 1e-15 * std::max(std::abs(bounds.first), std::abs(bounds.second));
    auto v = std::lower_bound(values.begin(), values.end(), bounds.first);
    for (; v != values.end() && *v <= bounds.second; ++v) {
        const double shifted[4] = {b[0] - *v, b[1] - *v, b[2] - *v, b[3] - *v};
        bisect(shifted, t0, t1, noise, roots);
    }
}

} // namespace oracle
} // namespace osgVolumizer
