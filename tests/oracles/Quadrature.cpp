#include "Quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgVolumizer {
namespace oracle {
namespace {

/// The Gauss method with N nodes on [0, 1].
template <int N>
struct Gauss
{
    std::array<double, N> node;
    std::array<double, N> weight;
    std::array<std::array<double, N>, N> inner; ///< inner[i][j]: integral of basis j to node i

    explicit Gauss(const std::array<double, N>& nodes) : node(nodes)
    {
        for (int j = 0; j < N; ++j) {
            std::array<double, N> basis{1.0}; // coefficients of Lagrange's polynomial j
            int degree = 0;
            for (int m = 0; m < N; ++m) {
                if (m == j) continue;
                std::array<double, N> next{};
                for (int k = 0; k <= degree; ++k) {
                    next[k + 1] += basis[k] / (node[j] - node[m]);
                    next[k] -= basis[k] * node[m] / (node[j] - node[m]);
                }
                basis = next;
                ++degree;
            }
            const auto integral = [&](double x) {
                double sum = 0.0;
                for (int k = N - 1; k >= 0; --k)
                    sum = sum * x + basis[k] / (k + 1);
                return sum * x;
            };
            weight[j] = integral(1.0);
            for (int i = 0; i < N; ++i)
                inner[i][j] = integral(node[i]);
        }
    }

    /// The light added per unit of transmittance, and the optical depth, over a step h.
    void step(const std::array<Medium, N>& medium, double h, glm::dvec3& color, double& depth) const
    {
        color = glm::dvec3(0.0);
        depth = 0.0;
        for (int i = 0; i < N; ++i) {
            double before = 0.0;
            for (int j = 0; j < N; ++j)
                before += inner[i][j] * medium[j].extinction;
            color += (h * weight[i] * std::exp(-h * before)) * medium[i].emission;
            depth += h * weight[i] * medium[i].extinction;
        }
    }
};

const Gauss<3> gauss3({0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)});

// Half of the nodes' distance from the middle: sqrt(5 -+ 2 sqrt(10/7)) / 6.
const double innerNode = std::sqrt(5.0 - 2.0 * std::sqrt(10.0 / 7.0)) / 6.0;
const double outerNode = std::sqrt(5.0 + 2.0 * std::sqrt(10.0 / 7.0)) / 6.0;
const Gauss<5> gauss5({0.5 - outerNode, 0.5 - innerNode, 0.5, 0.5 + innerNode, 0.5 + outerNode});

double distance(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

} // namespace

void integrate(const std::function<Medium(double)>& medium, double t0, double t1, double tolerance,
               Light& light)
{
    if (light.transmittance < 1e-16) return;
    const double h = t1 - t0;
    std::array<Medium, 5> five;
    for (int i = 0; i < 5; ++i)
        five[i] = medium(t0 + gauss5.node[i] * h);
    const std::array<Medium, 3> three{medium(t0 + gauss3.node[0] * h), five[2],
                                      medium(t0 + gauss3.node[2] * h)};
    glm::dvec3 color5, color3;
    double depth5, depth3;
    gauss5.step(five, h, color5, depth5);
    gauss3.step(three, h, color3, depth3);
    const double through = std::exp(-depth5);
    const double error = light.transmittance *
                         std::max(distance(color5, color3), std::abs(through - std::exp(-depth3)));
    const double middle = 0.5 * (t0 + t1);
    const bool divisible = middle > t0 && middle < t1 && h > 1e-14 * std::abs(t1);
    if (error > tolerance && divisible) {
        integrate(medium, t0, middle, tolerance, light);
        integrate(medium, middle, t1, tolerance, light);
        return;
    }
    light.color += light.transmittance * color5;
    light.transmittance *= through;
}

} // namespace oracle
} // namespace osgVolumizer
