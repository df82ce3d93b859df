#include "TetraMesh.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <queue>
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

std::size_t repairOrientation(TetraSet& set)
{
    std::size_t turned = 0;
    for (std::size_t t = 0; t < set.tetraCount(); ++t)
        if (orientation(set, t) < 0.0) {
            std::swap(set.indices[4 * t], set.indices[4 * t + 1]);
            ++turned;
        }
    return turned;
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

std::vector<std::array<TetraSet::Index, 3>> boundaryFaces(const TetraSet& set,
                                                          const Adjacency& adjacency)
{
    std::vector<std::array<TetraSet::Index, 3>> r;
    for (std::size_t t = 0; t < set.tetraCount(); ++t) {
        const bool inverted = orientation(set, t) < 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (adjacency.neighbours[t][i] != Adjacency::NONE) continue;
            std::array<TetraSet::Index, 3> f{};
            for (std::size_t k = 0; k < 3; ++k)
                f[k] = set.indices[4 * t + static_cast<std::size_t>(OPPOSITE[i][k])];
            if (inverted) std::swap(f[1], f[2]);
            r.push_back(f);
        }
    }
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

VisibilityOrder visibilityOrder(const TetraSet& set, const Adjacency& adjacency,
                                const glm::dvec4& eye)
{
    const std::size_t n = set.tetraCount();
    const auto side = [&](std::size_t t, int i) {
        // Positive where the eye is on the outer side of the face opposite vertex i.
        const glm::dvec3 a = corner(set, t, OPPOSITE[i][0]);
        const glm::dvec3 normal =
            glm::cross(corner(set, t, OPPOSITE[i][1]) - a, corner(set, t, OPPOSITE[i][2]) - a);
        const double s = glm::dot(normal, glm::dvec3(eye) - eye.w * a);
        return orientation(set, t) < 0.0 ? -s : s;
    };
    std::vector<double> depth(n);
    std::vector<std::uint32_t> behind(n, 0); // neighbours that have to go first
    for (std::size_t t = 0; t < n; ++t) {
        const glm::dvec3 c =
            0.25 * (corner(set, t, 0) + corner(set, t, 1) + corner(set, t, 2) + corner(set, t, 3));
        depth[t] =
            eye.w != 0.0 ? glm::length(c - glm::dvec3(eye) / eye.w) : -glm::dot(c, glm::dvec3(eye));
    }
    // t is before its neighbour over face i, seen from the eye, if the eye is inside that face.
    // Decided once per face, by the tetrahedron with the lower number, so that both sides agree.
    const auto isBehind = [&](std::size_t t, std::size_t i) {
        const auto other = static_cast<std::size_t>(adjacency.neighbours[t][i]);
        if (t < other) return side(t, static_cast<int>(i)) > 0.0;
        std::size_t back = 0;
        while (adjacency.neighbours[other][back] != static_cast<std::int32_t>(t))
            ++back;
        return side(other, static_cast<int>(back)) < 0.0;
    };
    const auto isBefore = [&](std::size_t t, std::size_t i) {
        const auto other = static_cast<std::size_t>(adjacency.neighbours[t][i]);
        std::size_t back = 0;
        while (adjacency.neighbours[other][back] != static_cast<std::int32_t>(t))
            ++back;
        return isBehind(other, back);
    };
    for (std::size_t t = 0; t < n; ++t)
        for (std::size_t i = 0; i < 4; ++i)
            if (adjacency.neighbours[t][i] != Adjacency::NONE && isBefore(t, i)) ++behind[t];

    // Kahn's topological sort; ready tetrahedra wait in a heap, farthest on top.
    const auto nearer = [&](std::uint32_t a, std::uint32_t b) {
        return depth[a] != depth[b] ? depth[a] < depth[b] : a > b;
    };
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, decltype(nearer)> ready(nearer);
    std::vector<std::uint32_t> byDepth(n);
    std::vector<bool> done(n, false);
    for (std::uint32_t t = 0; t < n; ++t) {
        byDepth[t] = t;
        if (behind[t] == 0) ready.push(t);
    }
    std::sort(byDepth.begin(), byDepth.end(),
              [&](std::uint32_t a, std::uint32_t b) { return nearer(b, a); });
    VisibilityOrder r;
    r.order.reserve(n);
    std::size_t farthest = 0;
    while (r.order.size() < n) {
        std::uint32_t t;
        if (!ready.empty()) {
            t = ready.top();
            ready.pop();
            if (done[t]) continue;
        } else {
            while (done[byDepth[farthest]])
                ++farthest;
            t = byDepth[farthest];
            r.cyclic.push_back(t);
        }
        done[t] = true;
        r.order.push_back(t);
        for (std::size_t i = 0; i < 4; ++i) {
            const std::int32_t other = adjacency.neighbours[t][i];
            if (other == Adjacency::NONE || done[static_cast<std::size_t>(other)]) continue;
            if (isBehind(t, i) && --behind[static_cast<std::size_t>(other)] == 0)
                ready.push(static_cast<std::uint32_t>(other));
        }
    }
    return r;
}

} // namespace core
} // namespace osgVolumizer
