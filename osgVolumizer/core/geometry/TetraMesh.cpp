#include "TetraMesh.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

/// The face opposite vertex i, counter-clockwise from outside in a positive tetrahedron.
constexpr int OPPOSITE[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct FaceKey
{
    std::array<TetraSet::Index, 3> vertices; ///< ascending
    std::uint32_t tetrahedron;
    std::uint32_t face;
};

glm::dvec3 corner(const TetraSet& set, std::size_t t, int i)
{
    return set.vertices.position(set.indices[4 * t + static_cast<std::size_t>(i)]);
}

} // namespace

double orientation(const TetraSet& set, std::size_t t)
{
    const glm::dvec3 a = corner(set, t, 0);
    return glm::dot(glm::cross(corner(set, t, 1) - a, corner(set, t, 2) - a),
                    corner(set, t, 3) - a);
}

double volume(const TetraSet& set)
{
    double six = 0.0;
    for (std::size_t t = 0; t < set.tetraCount(); ++t)
        six += std::abs(orientation(set, t));
    return six / 6.0;
}

Adjacency findAdjacency(const TetraSet& set)
{
    std::vector<FaceKey> faces;
    faces.reserve(4 * set.tetraCount());
    for (std::uint32_t t = 0; t < set.tetraCount(); ++t)
        for (std::uint32_t i = 0; i < 4; ++i) {
            FaceKey f{{}, t, i};
            for (std::size_t k = 0; k < 3; ++k)
                f.vertices[k] = set.indices[4 * t + static_cast<std::size_t>(OPPOSITE[i][k])];
            std::sort(f.vertices.begin(), f.vertices.end());
            faces.push_back(f);
        }
    std::sort(faces.begin(), faces.end(), [](const FaceKey& a, const FaceKey& b) {
        return a.vertices != b.vertices ? a.vertices < b.vertices : a.tetrahedron < b.tetrahedron;
    });
    Adjacency r;
    r.neighbours.assign(set.tetraCount(), {-1, -1, -1, -1});
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t j = i + 1;
        while (j < faces.size() && faces[j].vertices == faces[i].vertices)
            ++j;
        if (j - i == 2) {
            const FaceKey &a = faces[i], &b = faces[i + 1];
            r.neighbours[a.tetrahedron][a.face] = static_cast<std::int32_t>(b.tetrahedron);
            r.neighbours[b.tetrahedron][b.face] = static_cast<std::int32_t>(a.tetrahedron);
        }
        for (std::size_t k = i; j - i > 2 && k < j; ++k)
            r.nonManifold.push_back(faces[k].tetrahedron);
        i = j;
    }
    std::sort(r.nonManifold.begin(), r.nonManifold.end());
    r.nonManifold.erase(std::unique(r.nonManifold.begin(), r.nonManifold.end()),
                        r.nonManifold.end());
    return r;
}

Result<glm::dmat4> positionToVoxel(const TetraSet& set, std::size_t t)
{
    if (t >= set.tetraCount())
        return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                      "positionToVoxel: tetrahedron " + std::to_string(t) + " of " +
                          std::to_string(set.tetraCount()) + ".",
                      static_cast<std::int64_t>(t));
    glm::dmat3 p, v;
    const glm::dvec3 p0 = corner(set, t, 0);
    const glm::dvec3 v0 = set.vertices.voxelCoordinate(set.indices[4 * t]);
    for (int i = 0; i < 3; ++i) {
        p[i] = corner(set, t, i + 1) - p0;
        v[i] =
            set.vertices.voxelCoordinate(set.indices[4 * t + static_cast<std::size_t>(i) + 1]) - v0;
    }
    const double size = glm::length(p[0]) * glm::length(p[1]) * glm::length(p[2]);
    if (!(std::abs(glm::determinant(p)) > 1e-14 * size))
        return Status(ErrorCode::SINGULAR_MATRIX,
                      "positionToVoxel: tetrahedron " + std::to_string(t) + " has no volume.",
                      static_cast<std::int64_t>(t));
    const glm::dmat3 linear = v * glm::inverse(p);
    glm::dmat4 m(linear);
    m[3] = glm::dvec4(v0 - linear * p0, 1.0);
    return m;
}

} // namespace core
} // namespace osgVolumizer
