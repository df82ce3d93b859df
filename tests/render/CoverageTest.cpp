// Every pixel that a surface covers is drawn exactly once, by counting.

#include "Volumes.h"

#include <oracles/Ray.h>
#include <support/GLTest.h>

#include <cmath>

namespace CoverageTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 25;

struct Setup
{
    VolumeGeometry::BoxTessellation tessellation;
    int bricksPerAxis;
};

std::string setupName(const ::testing::TestParamInfo<Setup>& info)
{
    static const char* tessellations[] = {"Five", "TwentyFour", "Enclosing"};
    return std::string(tessellations[info.param.tessellation]) + "In" +
           std::to_string(info.param.bricksPerAxis);
}

class PixelCoverage : public support::GLTest, public ::testing::WithParamInterface<Setup>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        osg::ref_ptr<Voxels> voxels =
            makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 0.5; });
        const int brick = (SIZE - 1) / GetParam().bricksPerAxis + 1;
        ASSERT_TRUE(voxels->setBrickSize({brick, brick, brick}));
        _twin = makeTwin(voxels, constantPoints({1.0, 1.0, 1.0, ALPHA}));
        _twin.node->setChild(
            0, VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, SIZE - 1, SIZE - 1, SIZE - 1),
                                         GetParam().tessellation));
    }

    static constexpr double ALPHA = 1e-4;
    TwinVolume _twin;
};

std::vector<osg::Vec3d> directions()
{
    return {{1, 0, 0}, {0, -1, 0}, {1, 1, 0}, {1, -1, 1}, {3, 2, 1}, {-0.3, 0.2, -2}};
}

RenderOptions parallelView(const osg::Vec3d& towards)
{
    const osg::Vec3d center(12, 12, 12);
    return RenderOptions().size(96, 96).orthographic(24.0).lookAt(
        center + towards * 40.0 / towards.length(), center,
        std::abs(towards.z()) > 1.5 ? osg::Vec3d(0, 1, 0) : osg::Vec3d(0, 0, 1));
}

TEST_P(PixelCoverage, OncePerPlane)
{
    // A pixel's opacity is that of a whole number of layers: as many as there are planes between
    // its ray's ends.
    _twin.node->setTechnique(VolumeAppearance::SLICES);
    const double opacity = 0.02;
    _twin.node->setLookupTable(makeTable(constantPoints({1.0, 1.0, 1.0, opacity})));
    for (const osg::Vec3d& towards : directions()) {
        const RenderOptions options = parallelView(towards);
        const oracle::Camera camera = support::oracleCamera(options);
        const FloatImage image = support::renderScene(_twin.node, support::joining(options, false));
        // Depths of the surfaces: the middles of equal layers over the geometry.
        double nearest = 1e30, farthest = -1e30;
        const auto set = static_cast<VolumeGeometry*>(_twin.node->getChild(0))->getTetraSet();
        for (std::size_t i = 0; i < set->vertices.size(); ++i) {
            const double depth = -(camera.view * glm::dvec4(set->vertices.position(i), 1.0)).z;
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
        const double layers = std::ceil((farthest - nearest) * (1.0 - 1e-9));
        const double spacing = (farthest - nearest) / layers;
        std::size_t compared = 0, wrong = 0;
        double covered = 0.0;
        for (int y = 0; y < camera.height; ++y)
            for (int x = 0; x < camera.width; ++x) {
                oracle::Crossing c;
                const oracle::Ray ray = oracle::rayThrough(camera, x + 0.5, y + 0.5);
                const bool inside = oracle::cross(ray, camera, _twin.oracle, c);
                // Planes with enter < depth < leave, counted from the far end as the library does.
                const double first = inside ? (farthest - c.leave) / spacing - 0.5 : 0.0;
                const double last = inside ? (farthest - c.enter) / spacing - 0.5 : 0.0;
                const double expected = inside ? std::floor(last) - std::ceil(first) + 1.0 : 0.0;
                const auto near = [](double v) { return std::abs(v - std::round(v)) < 0.02; };
                if (inside && (near(first) || near(last))) continue; // on the outline of a slice
                const double alpha = -std::expm1(spacing * std::log1p(-opacity));
                const double count = std::log1p(-image.at(x, y).a) / std::log1p(-alpha);
                ++compared;
                covered += count > 0.5;
                if (std::abs(count - expected) > 0.01 && ++wrong < 4)
                    ADD_FAILURE() << count << " layers instead of " << expected << " at " << x
                                  << " " << y << ", seen from " << towards.x() << " " << towards.y()
                                  << " " << towards.z();
            }
        EXPECT_EQ(wrong, 0u);
        EXPECT_GT(compared, 6000u);
        EXPECT_GT(covered, 1500.0);
    }
}

TEST_P(PixelCoverage, OncePerSlab)
{
    // So transparent that a sum over bricks is what blending would give: a brick left out or drawn
    // twice would be a thousand times the tolerance.
    _twin.node->setTechnique(VolumeAppearance::SLABS);
    for (const osg::Vec3d& towards : directions()) {
        RenderOptions options = parallelView(towards);
        for (const bool perspective : {false, true}) {
            if (perspective) options.perspective(60.0);
            const FloatImage image =
                support::renderScene(_twin.node, support::joining(options, false));
            const FloatImage expected = oraclePicture(oracleScene(_twin.oracle), options);
            const support::Difference d = compare(image, expected);
            EXPECT_GT(d.pixels, 1500u);
            EXPECT_LT(d.maximum, 1e-5) << d.worstX << " " << d.worstY << " from " << towards.x()
                                       << " " << towards.y() << " " << towards.z();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Setups, PixelCoverage,
                         ::testing::Values(Setup{VolumeGeometry::FIVE, 1},
                                           Setup{VolumeGeometry::FIVE, 3},
                                           Setup{VolumeGeometry::TWENTY_FOUR, 2},
                                           Setup{VolumeGeometry::ENCLOSING, 2}),
                         setupName);

} // namespace

} // namespace CoverageTest
