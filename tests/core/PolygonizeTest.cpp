#include "osgVolumizer/core/sampling/Polygonize.h"
#include "TestGeometry.h"

#include <gtest/gtest.h>

#include <memory>

namespace PolygonizeTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

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

} // namespace PolygonizeTest
