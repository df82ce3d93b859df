// What holds for every input, tried on random and on nasty ones. Points are compared by their bits.

#include "TestGeometry.h"
#include "osgVolumizer/core/geometry/Orientation.h"
#include "osgVolumizer/core/geometry/Solids.h"
#include "osgVolumizer/core/geometry/TetraMesh.h"
#include "osgVolumizer/core/sampling/Sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <random>

namespace PolygonizePropertyTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

namespace {

using Bits = std::array<std::uint32_t, 3>;

Bits bitsOf(const FaceSet& faces, std::uint32_t vertex)
{
    Bits b;
    const float* p = faces.record(vertex) + faces.format.positionOffset();
    for (std::size_t k = 0; k < 3; ++k) {
        const float v = p[k] == 0.0f ? 0.0f : p[k]; // -0 is 0
        std::memcpy(&b[k], &v, 4);
    }
    return b;
}

float valueOf(std::uint32_t bits)
{
    float v;
    std::memcpy(&v, &bits, 4);
    return v;
}

/// n^3 cells in [0, n]^3; the inner vertices are moved (by 0.16 no cell can turn inside out), some
/// tetrahedra turned round, and all shuffled.
TetraSet jitteredGrid(int n, std::mt19937& random, double amount)
{
    TetraSet set = makeGrid(n, n);
    std::uniform_real_distribution<double> u(-amount, amount);
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
        glm::dvec3 p = set.vertices.position(i);
        for (int a = 0; a < 3; ++a)
            if (p[a] > 0.0 && p[a] < n)
                p[a] += random() % 4 ? u(random) : 0.0; // some stay on planes
        set.vertices.setPosition(i, p);
    }
    std::vector<std::array<TetraSet::Index, 4>> tetra(set.tetraCount());
    std::memcpy(tetra.data(), set.indices.data(), set.indices.size() * sizeof(TetraSet::Index));
    std::shuffle(tetra.begin(), tetra.end(), random);
    for (auto& t : tetra)
        if (random() % 3 == 0) std::swap(t[1], t[3]);
    std::memcpy(set.indices.data(), tetra.data(), set.indices.size() * sizeof(TetraSet::Index));
    return set;
}

std::vector<Box3d> latticeBoxes(const glm::dvec3& size, std::mt19937& random)
{
    std::vector<double> split[3];
    for (int a = 0; a < 3; ++a) {
        std::uniform_real_distribution<double> u(0.0, size[a]);
        split[a] = {0.0, u(random), std::floor(u(random) / size[a] * 4.0) * size[a] / 4.0, size[a]};
        std::sort(split[a].begin(), split[a].end());
        split[a].erase(std::unique(split[a].begin(), split[a].end()), split[a].end());
    }
    std::vector<Box3d> boxes;
    for (std::size_t z = 0; z + 1 < split[2].size(); ++z)
        for (std::size_t y = 0; y + 1 < split[1].size(); ++y)
            for (std::size_t x = 0; x + 1 < split[0].size(); ++x)
                boxes.push_back({{split[0][x], split[1][y], split[2][z]},
                                 {split[0][x + 1], split[1][y + 1], split[2][z + 1]}});
    std::shuffle(boxes.begin(), boxes.end(), random);
    return boxes;
}

/// Structure is sound, numbers are finite.
void expectSound(const PolygonizedFaces& out)
{
    ASSERT_EQ(out.ranges.size(), std::size_t(out.surfaceCount) * std::size_t(out.brickCount));
    ASSERT_EQ(out.surfaceDepths.size(), std::size_t(out.surfaceCount));
    ASSERT_EQ(out.faces.faceOffsets.back(), out.faces.indices.size());
    std::uint32_t face = 0, index = 0;
    for (const FaceRange& r : out.ranges) {
        ASSERT_EQ(r.firstFace, face);
        ASSERT_EQ(r.firstIndex, index);
        for (std::uint32_t f = 0; f < r.faceCount; ++f)
            ASSERT_GE(out.faces.faceOffsets[face + f + 1] - out.faces.faceOffsets[face + f], 3u);
        face += r.faceCount;
        index += r.indexCount;
        ASSERT_EQ(out.faces.faceOffsets[face], index);
    }
    ASSERT_EQ(face, out.faces.faceCount());
    for (const std::uint32_t i : out.faces.indices)
        ASSERT_LT(i, out.faces.vertexCount());
    for (const float v : out.faces.vertices)
        ASSERT_TRUE(std::isfinite(v));
}

/// In every surface, over all bricks, each edge is matched by its opposite, except on the hull
/// [low, low + size]: nothing missing, nothing double, no crack, one orientation.
void expectWatertight(const PolygonizedFaces& out, const glm::dvec3& size,
                      const glm::dvec3& low = glm::dvec3(0.0))
{
    for (int s = 0; s < out.surfaceCount; ++s) {
        std::map<std::pair<Bits, Bits>, int> edges;
        for (int b = 0; b < out.brickCount; ++b) {
            const FaceRange& r = out.range(s, b);
            for (std::uint32_t f = r.firstFace; f < r.firstFace + r.faceCount; ++f) {
                const std::uint32_t first = out.faces.faceOffsets[f],
                                    end = out.faces.faceOffsets[f + 1];
                for (std::uint32_t i = first; i < end; ++i) {
                    const Bits p = bitsOf(out.faces, out.faces.indices[i]);
                    const Bits q =
                        bitsOf(out.faces, out.faces.indices[i + 1 == end ? first : i + 1]);
                    if (p < q) ++edges[{p, q}];
                    if (q < p) --edges[{q, p}];
                }
            }
        }
        for (const auto& [edge, count] : edges) {
            if (count == 0) continue;
            bool onHull = false;
            for (std::size_t a = 0; a < 3; ++a)
                onHull = onHull || (edge.first[a] == edge.second[a] &&
                                    (valueOf(edge.first[a]) == float(low[int(a)]) ||
                                     valueOf(edge.first[a]) == float((low + size)[int(a)])));
            ASSERT_TRUE(onHull) << "surface " << s << ": " << valueOf(edge.first[0]) << " "
                                << valueOf(edge.first[1]) << " " << valueOf(edge.first[2]) << " to "
                                << valueOf(edge.second[0]) << " " << valueOf(edge.second[1]) << " "
                                << valueOf(edge.second[2]) << " counts " << count;
            ASSERT_EQ(std::abs(count), 1);
        }
    }
}

View randomView(std::mt19937& random, const glm::dvec3& scale)
{
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    View v;
    glm::dvec3 d(u(random), u(random), u(random));
    if (random() % 3 == 0) d = glm::round(d * 1.4); // along axes and diagonals
    if (glm::length(d) < 0.1) d = {0, 0, 1};
    v = viewAlong(d);
    v.toEye = v.toEye * glm::scale(glm::dmat4(1.0), 1.0 / scale);
    return v;
}

/// The faces of each bin, each as a list of points that starts with its lowest, sorted.
std::vector<std::vector<std::vector<Bits>>> canonical(const PolygonizedFaces& out)
{
    std::vector<std::vector<std::vector<Bits>>> bins;
    for (const FaceRange& r : out.ranges) {
        bins.emplace_back();
        for (std::uint32_t f = r.firstFace; f < r.firstFace + r.faceCount; ++f) {
            std::vector<Bits> face;
            for (std::uint32_t i = out.faces.faceOffsets[f]; i < out.faces.faceOffsets[f + 1]; ++i)
                face.push_back(bitsOf(out.faces, out.faces.indices[i]));
            face.erase(std::unique(face.begin(), face.end()), face.end());
            while (face.size() > 1 && face.front() == face.back())
                face.pop_back();
            std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
            bins.back().push_back(face);
        }
        std::sort(bins.back().begin(), bins.back().end());
    }
    return bins;
}

} // namespace

TEST(PolygonizeProperty, WatertightWithinAndAcrossBricks)
{
    std::mt19937 random(42);
    const glm::dvec3 scales[] = {{1, 1, 1}, {1e-9, 1.0, 1e9}, {1e-3, 1e-3, 1e12}, {7, 1e-6, 0.3}};
    for (int round = 0; round < 60; ++round) {
        const glm::dvec3 scale = scales[round % 4];
        TetraSet set = jitteredGrid(3 + round % 3, random, 0.15);
        const glm::dvec3 size = scale * double(3 + round % 3);
        for (std::size_t i = 0; i < set.vertices.size(); ++i)
            set.vertices.setPosition(i, set.vertices.position(i) * scale);
        SamplingParameters p;
        p.periodVoxel = scale * 0.23;
        p.mode = static_cast<SamplingMode>(round / 2 % 3);
        p.curvedTolerance = 0.3;
        if (round % 5 == 0) p.periodVoxel = scale * 0.5; // planes through vertices, along axes
        if (round % 7 == 0) p.space = SamplingSpace::VIEW_VOLUME;
        const View view = randomView(random, scale);
        PolygonizedFaces whole, cut;
        const Status status = polygonize(set, {}, view, p, whole);
        ASSERT_TRUE(status.ok()) << status.text;
        expectSound(whole);
        expectWatertight(whole, size);
        ASSERT_TRUE(polygonize(set, latticeBoxes(size, random), view, p, cut).ok());
        expectSound(cut);
        expectWatertight(cut, size);
        EXPECT_EQ(whole.surfaceCount, cut.surfaceCount);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
}

TEST(PolygonizeProperty, PlanesThroughVerticesEdgesAndFaces)
{
    // Along the axes with lattice planes exactly on the grid's, and bricks that end there as well.
    const TetraSet set = makeGrid(4, 4.0);
    std::vector<Box3d> boxes;
    for (int i = 0; i < 8; ++i)
        boxes.push_back({{i & 1 ? 2.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 3.0 : 0.0},
                         {i & 1 ? 4.0 : 2.0, i & 2 ? 4.0 : 1.0, i & 4 ? 4.0 : 3.0}});
    for (const glm::dvec3 d : {glm::dvec3(0, 0, 1), {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1, 1, 0}})
        for (const int count : {2, 4, 8, 16}) {
            // Layers of the lattice are chosen so that every other surface lies on grid planes.
            SamplingParameters p;
            p.mode = SamplingMode::AXIS_ALIGNED;
            p.space = SamplingSpace::VIEW_VOLUME;
            p.periodVoxel = glm::dvec3(4.0 / count);
            PolygonizedFaces out;
            ASSERT_TRUE(polygonize(set, boxes, viewAlong(d), p, out).ok());
            expectSound(out);
            expectWatertight(out, glm::dvec3(4.0));
            for (int s = 0; s < out.surfaceCount; ++s) {
                double a = 0.0;
                for (int b = 0; b < 8; ++b)
                    a += area(out.faces, out.range(s, b));
                EXPECT_NEAR(a, 16.0, 1e-5); // each plane is covered exactly once
            }
        }
}

TEST(PolygonizeProperty, IndependentOfOrderAndOrientation)
{
    std::mt19937 random(5);
    TetraSet set = jitteredGrid(4, random, 0.15);
    TetraSet other = set;
    std::vector<std::array<TetraSet::Index, 4>> tetra(set.tetraCount());
    std::memcpy(tetra.data(), set.indices.data(), set.indices.size() * sizeof(TetraSet::Index));
    std::shuffle(tetra.begin(), tetra.end(), random);
    for (auto& t : tetra)
        std::shuffle(t.begin(), t.end(), random);
    std::memcpy(other.indices.data(), tetra.data(), set.indices.size() * sizeof(TetraSet::Index));
    const std::vector<Box3d> boxes = latticeBoxes(glm::dvec3(4.0), random);
    for (const auto mode :
         {SamplingMode::VIEWPORT_ALIGNED, SamplingMode::AXIS_ALIGNED, SamplingMode::SPHERICAL}) {
        SamplingParameters p;
        p.mode = mode;
        p.periodVoxel = glm::dvec3(0.3);
        PolygonizedFaces a, b;
        ASSERT_TRUE(polygonize(set, boxes, viewAlong({1, 2, 3}), p, a).ok());
        ASSERT_TRUE(polygonize(other, boxes, viewAlong({1, 2, 3}), p, b).ok());
        EXPECT_EQ(canonical(a), canonical(b));
    }
}

TEST(PolygonizeProperty, IndependentOfTranslationByRepresentableOffsets)
{
    std::mt19937 random(6);
    TetraSet set = jitteredGrid(4, random, 0.15);
    for (double& v : set.vertices.values())
        v = std::round(v * 65536.0) / 65536.0;
    std::vector<Box3d> boxes = latticeBoxes(glm::dvec3(4.0), random);
    for (Box3d& b : boxes) {
        b.min = glm::round(b.min * 1024.0) / 1024.0;
        b.max = glm::round(b.max * 1024.0) / 1024.0;
    }
    View view = viewAlong({1, 2, 3});
    for (const glm::dvec3 offset :
         {glm::dvec3(6400000.0, -3200000.0, 1048576.0), glm::dvec3(0.25, 1e9, -64.5)}) {
        TetraSet moved = set;
        for (std::size_t i = 0; i < set.vertices.size(); ++i)
            moved.vertices.setPosition(i, set.vertices.position(i) + offset);
        std::vector<Box3d> movedBoxes = boxes;
        for (Box3d& b : movedBoxes)
            b = {b.min + offset, b.max + offset};
        View movedView = view;
        movedView.toEye = view.toEye * glm::translate(glm::dmat4(1.0), -offset);
        SamplingParameters p, q;
        p.periodVoxel = q.periodVoxel = glm::dvec3(0.3);
        q.outputOrigin = offset;
        PolygonizedFaces a, b;
        ASSERT_TRUE(polygonize(set, boxes, view, p, a).ok());
        ASSERT_TRUE(polygonize(moved, movedBoxes, movedView, q, b).ok());
        EXPECT_EQ(a.faces.vertices, b.faces.vertices);
        EXPECT_EQ(a.faces.indices, b.faces.indices);
        EXPECT_EQ(a.surfaceCount, b.surfaceCount);
        for (int s = 0; s < a.surfaceCount; ++s)
            EXPECT_NEAR(a.surfaceDepths[std::size_t(s)], b.surfaceDepths[std::size_t(s)], 1e-6);
    }
}

TEST(PolygonizeProperty, NastyTetrahedraAreHarmless)
{
    std::mt19937 random(8);
    std::uniform_real_distribution<double> u(-1.0, 1.0), magnitude(-9.0, 12.0);
    for (int round = 0; round < 300; ++round) {
        TetraSet set;
        set.vertices.resize(12);
        for (std::size_t i = 0; i < 12; ++i) {
            glm::dvec3 p(u(random), u(random), u(random));
            if (round % 2) p *= std::pow(10.0, magnitude(random)); // extents mixed over 1e21
            if (round % 3 == 0) p.z *= 1e-18;                      // slivers
            if (round % 5 == 0) p = glm::round(p * 2.0);           // many coincide
            set.vertices.setPosition(i, p);
        }
        for (int i = 0; i < 40; ++i)
            set.indices.push_back(random() % 12); // repeats included
        SamplingParameters p;
        p.periodVoxel = glm::dvec3(0.01);
        p.maximumSamples = 64;
        p.mode = static_cast<SamplingMode>(round % 2);
        p.space = static_cast<SamplingSpace>(round / 3 % 3);
        const Box3d b = set.bounds();
        PolygonizedFaces out;
        const std::vector<Box3d> boxes{{b.min, b.center()}, {b.center(), b.max}};
        const Status s = polygonize(set, boxes, randomView(random, glm::dvec3(1.0)), p, out);
        ASSERT_TRUE(s.ok()) << s.text;
        ASSERT_LE(out.surfaceCount, 64);
        expectSound(out);
    }
}

/// [-2, 2]^3 in eight mirrored cubes of six tetrahedra about the diagonal (Kuhn), each of which is
/// split at a point so near the origin that three of its four parts have a volume of 1e-18 of their
/// box.
TetraSet sliversAboutTheOrigin(std::mt19937& random)
{
    std::uniform_real_distribution<double> u(0.5, 1.0);
    TetraSet set;
    std::map<std::array<double, 3>, TetraSet::Index> known;
    const auto vertex = [&](const glm::dvec3& p) {
        const auto [at, added] =
            known.insert({{p.x + 0.0, p.y + 0.0, p.z + 0.0}, TetraSet::Index(known.size())});
        if (added) set.vertices.values().insert(set.vertices.values().end(), {p.x, p.y, p.z});
        return at->second;
    };
    for (int octant = 0; octant < 8; ++octant) {
        const glm::dvec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
        std::array<int, 3> axes{0, 1, 2};
        do {
            glm::dvec3 corner[4] = {}, inside(0.0);
            for (int k = 0; k < 3; ++k) {
                corner[k + 1] = corner[k];
                corner[k + 1][axes[std::size_t(k)]] = 2.0;
                inside[axes[std::size_t(k)]] = (3 - k) * u(random) * 1e-18;
            }
            // x > y > z > 0 in the order of the axes: inside.
            if (inside[axes[1]] >= inside[axes[0]]) std::swap(inside[axes[0]], inside[axes[1]]);
            inside[axes[2]] = std::min(inside[axes[2]], 0.5 * inside[axes[1]]);
            for (int without = 0; without < 4; ++without)
                for (int k = 0; k < 4; ++k)
                    set.indices.push_back(vertex(sign * (k == without ? inside : corner[k])));
        } while (std::next_permutation(axes.begin(), axes.end()));
    }
    return set;
}

TEST(PolygonizeProperty, SliversNeitherTearNorOverlap)
{
    std::mt19937 random(11);
    for (int round = 0; round < 40; ++round) {
        const TetraSet set = sliversAboutTheOrigin(random);
        SamplingParameters p;
        p.periodVoxel = glm::dvec3(round % 2 ? 0.37 : 4.0 / (1 + 2 * (round % 5)));
        // Along axes and diagonals with an odd number of layers, planes go right through them.
        View view = randomView(random, glm::dvec3(1.0));
        if (round % 4 == 0) view = viewAlong({0, 0, 1});
        if (round % 4 == 2) view = viewAlong({1, round % 8 == 2 ? 0 : 1, 1});
        PolygonizedFaces out;
        ASSERT_TRUE(polygonize(set, {}, view, p, out).ok());
        expectSound(out);
        expectWatertight(out, glm::dvec3(4.0), glm::dvec3(-2.0));
        PolygonizedFaces box;
        ASSERT_TRUE(polygonize(makeBox(glm::dvec3(-2.0), glm::dvec3(2.0)), {}, view, p, box).ok());
        ASSERT_EQ(out.surfaceCount, box.surfaceCount);
        for (int s = 0; s < out.surfaceCount; ++s)
            EXPECT_NEAR(area(out.faces, out.range(s, 0)), area(box.faces, box.range(s, 0)), 1e-5);
    }
}

TEST(PolygonizeProperty, SliversAnywhereHaveTheOrientationOfTheirNeighbours)
{
    // Cells whose tetrahedra are split at points next to a face: as near as rounding lets them be,
    // and on the inner side, in exact arithmetic. The rounded determinant of such a sliver has
    // either sign.
    std::mt19937 random(13);
    std::uniform_real_distribution<double> u(0.1, 1.0);
    for (int round = 0; round < 30; ++round) {
        const TetraSet coarse = jitteredGrid(3, random, 0.16);
        TetraSet set;
        set.vertices = coarse.vertices;
        std::size_t slivers = 0;
        for (std::size_t t = 0; t < coarse.tetraCount(); ++t) {
            const TetraSet::Index* v = &coarse.indices[4 * t];
            glm::dvec3 p[4];
            for (int k = 0; k < 4; ++k)
                p[k] = coarse.vertices.position(v[k]);
            const double a = u(random), b = u(random), c = u(random);
            const glm::dvec3 inside =
                (a * p[0] + b * p[1] + c * p[2]) / (a + b + c) + 1e-16 * (p[3] - p[0]);
            const int sign = orientationSign(p[0], p[1], p[2], p[3]);
            bool within = true;
            for (int k = 0; k < 4; ++k) {
                glm::dvec3 q[4] = {p[0], p[1], p[2], p[3]};
                q[k] = inside;
                within = within && orientationSign(q[0], q[1], q[2], q[3]) == sign;
            }
            if (!within) {
                set.indices.insert(set.indices.end(), v, v + 4);
                continue;
            }
            ++slivers;
            const auto middle = static_cast<TetraSet::Index>(set.vertices.size());
            set.vertices.values().insert(set.vertices.values().end(),
                                         {inside.x, inside.y, inside.z});
            for (int k = 0; k < 4; ++k)
                for (int i = 0; i < 4; ++i)
                    set.indices.push_back(i == k ? middle : v[i]);
        }
        EXPECT_GT(slivers, 10u);
        SamplingParameters p;
        p.periodVoxel = glm::dvec3(0.03);
        PolygonizedFaces out;
        ASSERT_TRUE(polygonize(set, {}, randomView(random, glm::dvec3(1.0)), p, out).ok());
        expectSound(out);
        expectWatertight(out, glm::dvec3(3.0));
    }
}

TEST(PolygonizeProperty, AreasOfSliversAddUpInDoublePrecision)
{
    /// Planes across a direction.
    struct Planes : SurfaceFamily
    {
        glm::dvec3 normal;
        double depth(const glm::dvec3& p, const glm::dvec3&) const override
        {
            return glm::dot(normal, p);
        }
        double spacing() const override { return 1.0; }
    };
    std::mt19937 random(12);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (int round = 0; round < 40; ++round) {
        const TetraSet set = sliversAboutTheOrigin(random);
        const TetraSet box = makeBox(glm::dvec3(-2.0), glm::dvec3(2.0));
        Planes planes;
        planes.normal = glm::normalize(glm::dvec3(u(random), u(random), u(random)));
        for (const double depth : {0.0, 1e-18, -3e-19, 0.3, -1.1}) {
            PolygonSet cut, expected;
            for (std::size_t t = 0; t < set.tetraCount(); ++t)
                ASSERT_TRUE(sample(set, t, planes, {depth}, cut).ok());
            for (std::size_t t = 0; t < box.tetraCount(); ++t)
                ASSERT_TRUE(sample(box, t, planes, {depth}, expected).ok());
            EXPECT_NEAR(area(cut), area(expected), 1e-12 * area(expected));
        }
    }
}

TEST(PolygonizeProperty, DepthsThatDifferByAlmostNothingAreHarmless)
{
    // 1e-310 of a layer: its reciprocal overflows.
    TetraSet set = makeBox(glm::dvec3(0.0), glm::dvec3(1.0));
    const auto first = static_cast<TetraSet::Index>(set.vertices.size());
    set.vertices.resize(first + 4);
    for (TetraSet::Index i = 0; i < 4; ++i) {
        set.vertices.setPosition(first + i, {i == 1, i == 2, i == 3 ? 1e-310 : 0.0});
        set.indices.push_back(first + i);
    }
    for (const auto space : {SamplingSpace::OBJECT, SamplingSpace::PRIMITIVE}) {
        SamplingParameters p;
        p.space = space;
        View view; // depth 0 in the plane z = 0
        view.projection = glm::ortho(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0);
        PolygonizedFaces out;
        ASSERT_TRUE(polygonize(set, {}, view, p, out).ok());
        expectSound(out);
        EXPECT_GE(out.faces.faceCount(), 5u);
    }
}

TEST(PolygonizeProperty, AnyNumberOfSurfacesInOneTetrahedron)
{
    // More than the lists of a block can number: the general way takes over.
    SamplingParameters p;
    p.periodVoxel = glm::dvec3(1e-9);
    for (const int count : {255, 256, 257, 65535, 65536, 70001}) {
        p.maximumSamples = count;
        PolygonizedFaces out;
        const TetraSet box = makeBox(glm::dvec3(0.0), glm::dvec3(4.0));
        ASSERT_TRUE(polygonize(box, {}, viewAlong({0, 0, 1}), p, out).ok());
        ASSERT_EQ(out.surfaceCount, count);
        expectSound(out);
        for (int s = 0; s < count; s += count / 50)
            EXPECT_NEAR(area(out.faces, out.range(s, 0)), 16.0, 1e-5);
        if (count < 1000) expectWatertight(out, glm::dvec3(4.0));
    }
}

TEST(PolygonizeProperty, TetrahedraWithoutVolumeGiveNoArea)
{
    TetraSet set = makeBox(glm::dvec3(0.0), {4.0, 4.0, 0.0});
    PolygonizedFaces out;
    for (const glm::dvec3 d : {glm::dvec3(0, 0, 1), {1, 0, 0}, {1, 2, 3}}) {
        ASSERT_TRUE(polygonize(set, {}, viewAlong(d), SamplingParameters(), out).ok());
        double a = 0.0;
        for (const FaceRange& r : out.ranges)
            a += area(out.faces, r);
        EXPECT_NEAR(a, 0.0, 1e-6);
    }
    ASSERT_TRUE(polygonize(TetraSet(), {}, viewAlong({1, 0, 0}), SamplingParameters(), out).ok());
    EXPECT_EQ(out.surfaceCount, 0);
    EXPECT_TRUE(out.faces.empty());
}

TEST(PolygonizeProperty, BoxTessellationsAgreeWithinTheirClipBox)
{
    const Box3d box{{1, 2, 3}, {6, 5, 9}};
    for (const glm::dvec3 d : {glm::dvec3(1, 2, 3), {0, 0, 1}, {-3, 1, 0.2}}) {
        std::vector<double> areas[3];
        for (int how = 0; how < 3; ++how) {
            // The enclosing tetrahedron has a wider range of depths: one lattice for all.
            SamplingParameters p;
            p.space = SamplingSpace::VIEW_VOLUME;
            p.periodVoxel = glm::dvec3(0.25);
            PolygonizedFaces out;
            const TetraSet set = tessellateBox(box, static_cast<BoxTessellation>(how));
            ASSERT_TRUE(polygonize(set, {box}, viewAlong(d), p, out).ok());
            for (int s = 0; s < out.surfaceCount; ++s) {
                const double a = area(out.faces, out.range(s, 0));
                if (a > 1e-4) areas[how].push_back(a);
            }
        }
        ASSERT_EQ(areas[0].size(), areas[1].size());
        ASSERT_EQ(areas[0].size(), areas[2].size());
        for (std::size_t i = 0; i < areas[0].size(); ++i) {
            EXPECT_NEAR(areas[0][i], areas[1][i], 1e-4);
            EXPECT_NEAR(areas[0][i], areas[2][i], 1e-4);
        }
    }
}

} // namespace PolygonizePropertyTest
