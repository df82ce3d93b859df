#include "PickOracle.h"

#include <osgVolumizer/interact/Measure.h>

namespace MeasureTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

const osg::Vec3d NOT_A_NUMBER(std::nan(""), 0, 0);

TEST(Measure, LengthsAndAngles)
{
    EXPECT_DOUBLE_EQ(*polylineLength({{0, 0, 0}, {3, 4, 0}, {3, 4, 2}}), 7.0);
    EXPECT_DOUBLE_EQ(*polylineLength({}), 0.0);
    EXPECT_EQ(polylineLength({{0, 0, 0}, NOT_A_NUMBER}).status.index, 1);
    EXPECT_NEAR(*angleAt({1, 1, 1}, {2, 1, 1}, {1, 5, 1}), 1.5707963267948966, 1e-15);
    EXPECT_NEAR(*angleAt({0, 0, 0}, {1, 0, 0}, {1, 1e-9, 0}), 1e-9, 1e-18);
    EXPECT_EQ(angleAt({1, 1, 1}, {1, 1, 1}, {1, 5, 1}).status.code, ErrorCode::VALUE_INVALID);
}

TEST(Measure, AreaOfAPolygon)
{
    EXPECT_DOUBLE_EQ(*polygonArea({{0, 0, 5}, {4, 0, 5}, {4, 3, 5}, {0, 3, 5}}), 12.0);
    // Not convex, far away.
    const osg::Vec3d far(6.4e6, -6.4e6, 6.4e6);
    std::vector<osg::Vec3d> corners;
    for (const osg::Vec3d& c : {osg::Vec3d(0, 0, 0), osg::Vec3d(4, 0, 0), osg::Vec3d(4, 4, 0),
                                osg::Vec3d(2, 1, 0), osg::Vec3d(0, 4, 0)})
        corners.push_back(c + far);
    EXPECT_NEAR(*polygonArea(corners), 10.0, 1e-6);
}

TEST(Measure, RefusesPolygonsThatAreNone)
{
    const auto refusal = [](const std::vector<osg::Vec3d>& corners) {
        return polygonArea(corners).status;
    };
    EXPECT_NE(refusal({{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}}).text.find("crosses itself"),
              std::string::npos);
    EXPECT_FALSE(refusal({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}).ok()); // touches
    EXPECT_FALSE(refusal({{0, 0, 0}, {4, 0, 0}, {2, 0, 0}, {2, 3, 0}}).ok()); // folds back
    EXPECT_FALSE(refusal({{0, 0, 0}, {4, 0, 0}, {4, 4, 1}, {0, 4, 0}}).ok()); // not flat
    EXPECT_FALSE(refusal({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}).ok());
    EXPECT_FALSE(refusal({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).ok());
    EXPECT_FALSE(refusal({{0, 0, 0}, {1, 0, 0}, NOT_A_NUMBER}).ok());
    EXPECT_FALSE(refusal({{0, 0, 0}, {1, 0, 0}}).ok());
    EXPECT_EQ(refusal(std::vector<osg::Vec3d>(5000)).code, ErrorCode::TOO_LARGE);
}

TEST(Measure, VolumeOfTetrahedra)
{
    const auto box = VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 2, 3, 4));
    EXPECT_NEAR(tetraVolume(*box), 24.0, 1e-12);
    EXPECT_NEAR(tetraVolume(*box, osg::Matrixd::scale(-2, 1, 1)), 48.0, 1e-12);
    EXPECT_EQ(tetraVolume(*osg::ref_ptr<VolumeGeometry>(new VolumeGeometry)), 0.0);
}

TEST(Measure, VolumeOfValues)
{
    const auto voxels = makeVoxels(glm::ivec3(21), [](const glm::dvec3& p) { return p.x; });
    voxels->setSpacing({2, 1, 0.5});
    EXPECT_DOUBLE_EQ(*valueVolume(*voxels, 4.0, 6.0), 3 * 21 * 21);
    ASSERT_TRUE(voxels->setBrickSize({8, 9, 10}).ok()); // no sample counts twice
    EXPECT_DOUBLE_EQ(*valueVolume(*voxels, 4.0, 6.0), 3 * 21 * 21);
    ASSERT_TRUE(voxels->setPartialBricks(core::PartialBricks::AVERAGE_UP).ok());
    EXPECT_DOUBLE_EQ(*valueVolume(*voxels, 4.0, 6.0), 3 * 21 * 21);
    EXPECT_DOUBLE_EQ(*valueVolume(*voxels, 18.0, 20.0), 3 * 21 * 21); // in bricks moved back
    const auto part = VolumeGeometry::createBox(osg::BoundingBoxd(0, -0.5, -1, 100, 4.5, 100));
    EXPECT_DOUBLE_EQ(*valueVolume(*voxels, 4.0, 6.0, part), 3 * 5 * 21);
    EXPECT_DOUBLE_EQ(
        *valueVolume(*voxels, 4.0, 6.0, osg::ref_ptr<VolumeGeometry>(new VolumeGeometry)), 0.0);
    EXPECT_EQ(valueVolume(*voxels, 6.0, 4.0).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(valueVolume(*voxels, std::nan(""), 4.0).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(valueVolume(*osg::ref_ptr<Voxels>(new Voxels), 0.0, 4.0).status.code,
              ErrorCode::VALUE_INVALID);
}

} // namespace

} // namespace MeasureTest
