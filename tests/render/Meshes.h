#pragma once

#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace osgVolumizer {
namespace test {

/// Triangles that share points, in the world frame. Points are what floats hold, so that GL and the
/// oracle have the same ones.
struct Mesh
{
    std::vector<glm::vec3> points;
    std::vector<std::array<unsigned, 3>> triangles;
};

inline Mesh quadMesh(const std::array<glm::vec3, 4>& corners)
{
    return {{corners.begin(), corners.end()}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A closed sphere of 2 * slices * (stacks - 1) triangles about the z axis.
inline Mesh sphereMesh(const glm::dvec3& center, double radius, int slices, int stacks)
{
    const double pi = glm::pi<double>();
    Mesh mesh;
    const auto at = [&](double polar, double azimuth) {
        return glm::vec3(center + radius * glm::dvec3(std::sin(polar) * std::cos(azimuth),
                                                      std::sin(polar) * std::sin(azimuth),
                                                      std::cos(polar)));
    };
    mesh.points.push_back(at(0.0, 0.0));
    for (int i = 1; i < stacks; ++i)
        for (int j = 0; j < slices; ++j)
            mesh.points.push_back(at(pi * i / stacks, 2.0 * pi * j / slices));
    mesh.points.push_back(at(pi, 0.0));
    const auto last = static_cast<unsigned>(mesh.points.size() - 1);
    const auto ring = [&](int i, int j) {
        return static_cast<unsigned>(1 + i * slices + j % slices);
    };
    for (int j = 0; j < slices; ++j) {
        mesh.triangles.push_back({0, ring(0, j), ring(0, j + 1)});
        for (int i = 0; i + 2 < stacks; ++i) {
            mesh.triangles.push_back({ring(i, j), ring(i + 1, j), ring(i + 1, j + 1)});
            mesh.triangles.push_back({ring(i, j), ring(i + 1, j + 1), ring(i, j + 1)});
        }
        mesh.triangles.push_back({ring(stacks - 2, j), last, ring(stacks - 2, j + 1)});
    }
    return mesh;
}

/// The side of a prism from one point to another, without caps.
inline Mesh rodMesh(const glm::dvec3& from, const glm::dvec3& to, double radius, int sides)
{
    const glm::dvec3 axis = glm::normalize(to - from);
    const glm::dvec3 other = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
    Mesh mesh;
    for (int j = 0; j < sides; ++j) {
        const double angle = 2.0 * glm::pi<double>() * j / sides;
        const glm::dvec3 d = radius * (std::cos(angle) * u + std::sin(angle) * v);
        mesh.points.emplace_back(from + d);
        mesh.points.emplace_back(to + d);
        const auto a = static_cast<unsigned>(2 * j);
        const auto b = static_cast<unsigned>(2 * ((j + 1) % sides));
        mesh.triangles.push_back({a, b, b + 1});
        mesh.triangles.push_back({a, b + 1, a + 1});
    }
    return mesh;
}

} // namespace test
} // namespace osgVolumizer
