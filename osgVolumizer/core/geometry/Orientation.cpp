#include "Orientation.h"

#include <cmath>
#include <vector>

namespace osgVolumizer {
namespace core {

namespace {

/// An exact number: the sum of its parts, which do not overlap and grow in magnitude.
using Expansion = std::vector<double>;

/// Adds without rounding (Shewchuk's Grow-Expansion, by Knuth's sum of two numbers).
void add(Expansion& e, double b)
{
    for (double& part : e) {
        const double sum = b + part, other = sum - b;
        part = (b - (sum - other)) + (part - other);
        b = sum;
    }
    e.push_back(b);
}

/// The exact difference of two numbers.
Expansion difference(double a, double b)
{
    Expansion e{a};
    add(e, -b);
    return e;
}

/// Adds sign * e * f.
void addProduct(Expansion& sum, const Expansion& e, const Expansion& f, double sign)
{
    for (const double x : e)
        for (const double y : f) {
            const double product = x * y * sign;
            add(sum, std::fma(x * sign, y, -product));
            add(sum, product);
        }
}

int exactSign(const glm::dvec3& o, const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& r)
{
    Expansion m[3][3];
    const glm::dvec3* ends[3] = {&p, &q, &r};
    for (int i = 0; i < 3; ++i)
        for (int a = 0; a < 3; ++a)
            m[i][a] = difference((*ends[i])[a], o[a]);
    Expansion determinant;
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        Expansion minor;
        addProduct(minor, m[1][b], m[2][c], 1.0);
        addProduct(minor, m[1][c], m[2][b], -1.0);
        addProduct(determinant, m[0][a], minor, 1.0);
    }
    for (auto part = determinant.rbegin(); part != determinant.rend(); ++part)
        if (*part != 0.0) return *part > 0.0 ? 1 : -1;
    return 0;
}

} // namespace

int orientationSign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                    const glm::dvec3& d)
{
    const glm::dvec3 p = b - a, q = c - a, r = d - a;
    double determinant = 0.0, permanent = 0.0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double u = q[j] * r[k], v = q[k] * r[j];
        determinant += p[i] * (u - v);
        permanent += std::abs(p[i]) * (std::abs(u) + std::abs(v));
    }
    constexpr double BOUND = 8e-16; // (7 + 56 u) u, u = 2^-53, rounded up
    if (determinant > BOUND * permanent) return 1;
    if (determinant < -BOUND * permanent) return -1;
    return exactSign(a, b, c, d);
}

} // namespace core
} // namespace osgVolumizer
