// A volume looks the same however it is cut into bricks.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Precision.h>

#include <algorithm>

namespace BricksTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis

RenderOptions view(const osg::Vec3d& eye, const osg::Vec3d& center, double fovy)
{
    RenderOptions options;
    options.size(90, 80).lookAt(eye, center, {0, 0, 1});
    if (fovy > 0.0)
        options.perspective(fovy);
    else
        options.orthographic(28.0);
    return options;
}

// Along an axis, with rays exactly in the planes where bricks meet.
RenderOptions aligned(const osg::Vec3d& eye, const osg::Vec3d& up)
{
    RenderOptions options = view(eye, {16, 16, 16}, 0.0);
    options.lookAt(eye, {16, 16, 16}, up);
    options.projection.makeOrtho(-20.25, 24.75, -19.75, 20.25, 1.0, 10000.0);
    return options;
}

std::vector<RenderOptions> views()
{
    const osg::Vec3d middle(16, 16, 16);
    return {view({70, -50, 60}, middle, 40.0),   // a corner
            view({-30, 17, 16.5}, middle, 60.0), // nearly along an axis
            view({50, 16, 16}, middle, 0.0),     // along an axis
            view({-40, -30, 70}, middle, 0.0),
            view({16.3, 15.8, 16.1}, {30, 25, 20}, 60.0), // inside, at the corner of eight bricks
            view({5, 5, 5}, {10, 30, 12}, 90.0),          // inside
            aligned({50, 16, 16}, {0, 0, 1}),
            aligned({-50, 16, 16}, {0, 0, 1}),
            aligned({16, 50, 16}, {0, 0, 1}),
            aligned({16, 16, 60}, {-1, 0, 0}),
            aligned({16, 16, -60}, {0, 1, 0})};
}

// bumps() that fade out towards the border of the box. The outline of a slice is cut where bricks
// meet, and GL rounds those points to fractions of a pixel; this leaves only what happens inside.
double fadingBumps(const glm::dvec3& p)
{
    const glm::dvec3 q = p * (SIZE - 1.0 - p) / (0.25 * (SIZE - 1.0) * (SIZE - 1.0));
    return bumps(p) * std::min({1.0, 2.0 * q.x, 2.0 * q.y, 2.0 * q.z});
}

class Bricks : public support::GLTest,
               public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
};

TEST_P(Bricks, OneEightAndSixtyFourShowTheSame)
{
    const bool slabs = GetParam() == VolumeAppearance::SLABS;
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), slabs ? bumps : fadingBumps);
    TwinVolume twin = makeTwin(voxels, smoothPoints(0.15), GetParam());
    // Places in textures of other sizes are rounded to other floats, and some to other weights.
    support::filterExactly(*twin.node);
    const std::vector<RenderOptions> all = views();
    for (std::size_t v = 0; v < all.size(); ++v) {
        FloatImage whole;
        for (const int perAxis : {1, 2, 4}) {
            const int brick = (SIZE - 1) / perAxis + 1;
            ASSERT_TRUE(voxels->setBrickSize({brick, brick, brick}));
            ASSERT_EQ(voxels->getLayout().brickCount(), perAxis * perAxis * perAxis);
            FloatImage image = support::renderScene(twin.node, all[v]);
            support::savePicture(image, "bricks_" + std::to_string(GetParam()) + "_view" +
                                            std::to_string(v) + "_" + std::to_string(perAxis));
            if (perAxis == 1) {
                whole = image;
                EXPECT_GT(support::coveredPixels(image, 0.3f).count(), 1000u);
                continue;
            }
            for (const bool joined : {true, false}) {
                if (!joined)
                    image = support::renderScene(twin.node, support::joining(all[v], false));
                const support::Difference d = compare(image, whole);
                EXPECT_LT(d.maximum, joined && slabs ? 1e-6 : 1e-4)
                    << "view " << v << ", " << perAxis << " bricks per axis, at " << d.worstX << " "
                    << d.worstY << (joined ? ", joined" : "");
            }
        }
    }
}

TEST_P(Bricks, UnevenOnesAgreeWithTheOracle)
{
    // Sizes that no brick size divides, and a brick of one layer of cells at the end.
    osg::ref_ptr<Voxels> voxels = makeVoxels({18, 25, 12}, bumps);
    ASSERT_TRUE(voxels->setBrickSize({9, 7, 11}));
    TwinVolume twin = makeTwin(voxels, smoothPoints(0.05), GetParam());
    twin.setPeriod(0.25);
    const RenderOptions options = view({40, -30, 30}, {8, 12, 6}, 45.0);
    const FloatImage expected = oraclePicture(oracleScene(twin.oracle), options);
    for (const bool joined : {true, false}) {
        const FloatImage image = support::renderScene(twin.node, support::joining(options, joined));
        EXPECT_LT(compare(image, expected).rmse, 2e-3);
    }
}

TEST_P(Bricks, PartialOnesShowAllOrWhatFills)
{
    const RenderOptions options = view({40, -30, 30}, {12, 12, 6}, 45.0);
    const auto picture = [&](const glm::ivec3& size, core::PartialBricks partial) {
        // The corner of one volume, whatever its size.
        const osg::ref_ptr<Voxels> voxels = makeVoxels(size, bumps);
        EXPECT_TRUE(voxels->setBrickSize({9, 7, 11}));
        EXPECT_TRUE(voxels->setPartialBricks(partial));
        TwinVolume twin = makeTwin(voxels, smoothPoints(0.05), GetParam());
        twin.setPeriod(0.25);
        support::filterExactly(*twin.node);
        return support::renderScene(twin.node, options);
    };
    using core::PartialBricks;
    const glm::ivec3 size(20, 25, 15);
    const FloatImage all = picture(size, PartialBricks::SHRINK_TO_FIT);
    EXPECT_GT(support::coveredPixels(all, 0.3f).count(), 500u);
    EXPECT_LT(compare(picture(size, PartialBricks::AVERAGE_UP), all).maximum, 1e-4);
    const FloatImage less = picture(size, PartialBricks::TRUNCATE);
    EXPECT_GT(compare(less, all).maximum, 0.1);
    // Of x 17 samples fill two bricks, of y all do, of z 11 fill one.
    const osg::ref_ptr<Voxels> voxels = makeVoxels(size, bumps);
    ASSERT_TRUE(voxels->setBrickSize({9, 7, 11}));
    TwinVolume twin = makeTwin(voxels, smoothPoints(0.05), GetParam());
    twin.setPeriod(0.25);
    support::filterExactly(*twin.node);
    twin.node->removeChildren(0, twin.node->getNumChildren());
    twin.node->addChild(VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 16, 24, 10)));
    EXPECT_LT(compare(less, support::renderScene(twin.node, options)).rmse, 1e-3);
    EXPECT_FALSE(voxels->setPartialBricks(static_cast<PartialBricks>(7)));
    EXPECT_EQ(voxels->getPartialBricks(), PartialBricks::SHRINK_TO_FIT);
}

INSTANTIATE_TEST_SUITE_P(Techniques, Bricks,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

} // namespace

} // namespace BricksTest
