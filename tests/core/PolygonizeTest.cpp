#include "osgVolumizer/core/sampling/Polygonize.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <memory>

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

/// A unit-spaced box in five tetrahedra.
TetraSet makeBox(const glm::dvec3& min, const glm::dvec3& max)
{
    TetraSet set;
    set.vertices.resize(8);
    const Box3d box{min, max};
    for (int i = 0; i < 8; ++i)
        set.vertices.setPosition(std::size_t(i), box.corner(i));
    set.indices = {0, 3, 5, 6, 1, 3, 0, 5, 2, 0, 3, 6, 4, 5, 0, 6, 7, 3, 6, 5};
    return set;
}

View viewAlong(const glm::dvec3& direction)
{
    View view;
    const glm::dvec3 up =
        std::abs(glm::normalize(direction).z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    view.toEye = glm::lookAt(glm::normalize(direction) * -300.0, glm::dvec3(0.0), up);
    view.projection = glm::perspective(1.0, 1.0, 1.0, 1000.0);
    return view;
}

double area(const FaceSet& faces, const FaceRange& range, glm::dvec3* sum = nullptr)
{
    glm::dvec3 total(0.0);
    double r = 0.0;
    for (std::uint32_t f = range.firstFace; f < range.firstFace + range.faceCount; ++f) {
        glm::dvec3 n(0.0);
        const std::uint32_t first = faces.faceOffsets[f];
        const glm::dvec3 a = faces.position(faces.indices[first]);
        for (std::uint32_t i = first + 1; i + 1 < faces.faceOffsets[f + 1]; ++i)
            n += 0.5 * glm::cross(faces.position(faces.indices[i]) - a,
                                  faces.position(faces.indices[i + 1]) - a);
        total += n;
        r += glm::length(n);
    }
    if (sum) *sum += total;
    return r;
}

} // namespace

TEST(Polygonize, HeadOnGivesNumberOfVoxelsOverPeriod)
{
    const TetraSet box = makeBox(glm::dvec3(0.0), glm::dvec3(64.0));
    SamplingParameters p;
    PolygonizedFaces out;
    ASSERT_TRUE(polygonize(box, {}, viewAlong({0, 0, -1}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 64);
    ASSERT_TRUE(polygonize(box, {}, viewAlong({1, 1, 1}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 111); // ceil(64 sqrt 3)
    p.periodVoxel = glm::dvec3(0.5);
    ASSERT_TRUE(polygonize(box, {}, viewAlong({0, 1, 0}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 128);
    p.maximumSamples = 10;
    ASSERT_TRUE(polygonize(box, {}, viewAlong({0, 1, 0}), p, out).ok());
    EXPECT_EQ(out.surfaceCount, 10);
}

TEST(Polygonize, AreasTimesSpacingIsTheVolumeAndBricksTile)
{
    const TetraSet box = makeBox(glm::dvec3(0.0), glm::dvec3(8.0));
    std::vector<Box3d> bricks;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 low(i & 1 ? 3.5 : 0.0, i & 2 ? 4.0 : 0.0, i & 4 ? 2.25 : 0.0);
        const glm::dvec3 high(i & 1 ? 8.0 : 3.5, i & 2 ? 8.0 : 4.0, i & 4 ? 8.0 : 2.25);
        bricks.push_back({low, high});
    }
    for (const SamplingMode mode :
         {SamplingMode::VIEWPORT_ALIGNED, SamplingMode::AXIS_ALIGNED, SamplingMode::SPHERICAL})
        for (const SamplingSpace space : {SamplingSpace::OBJECT, SamplingSpace::VIEW_VOLUME}) {
            SamplingParameters p;
            p.mode = mode;
            p.space = space;
            p.periodVoxel = glm::dvec3(0.1);
            p.maximumSamples = 100000;
            PolygonizedFaces whole, cut;
            const View view = viewAlong({1, 2, 3});
            ASSERT_TRUE(polygonize(box, {}, view, p, whole).ok());
            ASSERT_TRUE(polygonize(box, bricks, view, p, cut).ok());
            EXPECT_EQ(whole.surfaceCount, cut.surfaceCount);
            double volume = 0.0, cutVolume = 0.0;
            for (int s = 0; s < whole.surfaceCount; ++s) {
                glm::dvec3 normal(0.0);
                const double a = area(whole.faces, whole.range(s, 0), &normal);
                double b = 0.0;
                for (int i = 0; i < 8; ++i)
                    b += area(cut.faces, cut.range(s, i));
                EXPECT_NEAR(a, b, 1e-4 + 1e-6 * a);
                volume += a * whole.spacing;
                cutVolume += b * whole.spacing;
                if (mode != SamplingMode::SPHERICAL) {
                    EXPECT_NEAR(glm::length(normal), a, 1e-4);
                }
            }
            EXPECT_NEAR(volume, 512.0, 0.5) << int(mode) << int(space);
            EXPECT_NEAR(cutVolume, volume, 1e-3);
        }
}
