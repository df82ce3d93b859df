// Picks and probes see what a cut leaves.
#include "PickOracle.h"

#include <osgVolumizer/VolumeCut.h>
#include <osgVolumizer/interact/Probe.h>

#include <osg/ShapeDrawable>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/PolytopeIntersector>

namespace CutPickTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

constexpr int SIZE = 33;
const osg::Vec3d MIDDLE(16, 16, 16);

// Opaque everywhere: what is hit first is the surface of what is left.
osg::ref_ptr<VolumeAppearance> solid(const std::vector<CutRegion>& regions)
{
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeBlob(glm::ivec3(SIZE), 1e6));
    osg::ref_ptr<LookupTable> table = new LookupTable;
    table->setPoints({{0.0, {1, 1, 1, 0.999999}}, {1.0, {1, 1, 1, 0.999999}}},
                     LookupTable::RANGE_FRACTION);
    volume->setLookupTable(table);
    volume->setCut(new VolumeCut);
    for (const CutRegion& region : regions)
        EXPECT_TRUE(volume->getCut()->addRegion(region));
    return volume;
}

std::optional<PickHit> pick(const VolumeAppearance& volume, const osg::Vec3d& start,
                            const osg::Vec3d& end)
{
    const auto hit =
        pickVolume(*dynamic_cast<const VolumeGeometry*>(volume.getChild(0)), volume, start, end);
    EXPECT_TRUE(hit.ok());
    return hit.value;
}

} // namespace

TEST(CutPick, FindsTheSurfaceOfWhatIsLeft)
{
    const osg::Vec3d start(-20, 15, 17), end(60, 17, 15);
    const osg::Vec3d direction = (end - start) / (end - start).length();
    // Where the line meets the sphere.
    const double along = (MIDDLE - start) * direction;
    const double off = ((MIDDLE - start) - direction * along).length();
    const double half = std::sqrt(10.0 * 10.0 - off * off);
    const auto inside = pick(*solid({CutRegion::sphere(MIDDLE, 10.0)}), start, end);
    ASSERT_TRUE(inside);
    EXPECT_NEAR((inside->point - start).length(), along - half, 0.1);
    // Out of the middle of a cavity it is its far side.
    const auto cavity = pick(*solid({CutRegion::sphere(MIDDLE, 10.0).complement()}), MIDDLE,
                             MIDDLE + direction * 50);
    ASSERT_TRUE(cavity);
    EXPECT_NEAR((cavity->point - MIDDLE).length(), 10.0, 0.1);
    const auto plane = pick(*solid({CutRegion::halfSpace({1, 0, 0, -20.5})}), start, end);
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->point.x(), 20.5, 0.1);
    osg::ref_ptr<osg::ShapeDrawable> ball = new osg::ShapeDrawable(new osg::Sphere(MIDDLE, 10.0f));
    const auto mesh = pick(*solid({CutRegion::surface(*ball)}), start, end);
    ASSERT_TRUE(mesh);
    EXPECT_NEAR((mesh->point - start).length(), along - half, 0.3); // of so many triangles
    EXPECT_FALSE(pick(*solid({CutRegion::sphere(MIDDLE, 1.0)}), {-20, 30, 30}, {60, 30, 30}));
    // Fading ones are where half is left.
    const osg::ref_ptr<VolumeAppearance> soft = solid({CutRegion::sphere(MIDDLE, 10.0)});
    ASSERT_TRUE(soft->getCut()->setSoftness(3.0));
    EXPECT_NEAR((pick(*soft, start, end)->point - start).length(), along - half, 0.1);
}

TEST(CutPick, ProbesEndAtTheCut)
{
    const osg::ref_ptr<VolumeAppearance> volume = solid({CutRegion::sphere(MIDDLE, 8.0)});
    const auto found = probe(*dynamic_cast<const VolumeGeometry*>(volume->getChild(0)), *volume,
                             {16, 16, -10}, {16, 16, 50});
    ASSERT_TRUE(found.ok());
    ASSERT_EQ(found->voxels.size(), 17u); // samples 8 to 24
    EXPECT_EQ(found->voxels.front().index, osg::Vec3i(16, 16, 8));
    EXPECT_NEAR(found->voxels.front().length, 0.5, 1e-6);
    EXPECT_EQ(found->voxels.back().index, osg::Vec3i(16, 16, 24));
}

TEST(CutPick, PolytopesFindWhatIsLeft)
{
    const auto hits = [](VolumeAppearance& volume) {
        osg::Polytope column;
        for (const osg::Plane& plane : {osg::Plane(1, 0, 0, -2), osg::Plane(-1, 0, 0, 4),
                                        osg::Plane(0, 1, 0, -2), osg::Plane(0, -1, 0, 4)})
            column.add(plane);
        osg::ref_ptr<osgUtil::PolytopeIntersector> intersector =
            new osgUtil::PolytopeIntersector(column);
        osgUtil::IntersectionVisitor visitor(intersector);
        volume.accept(visitor);
        return intersector->getIntersections().size();
    };
    EXPECT_GT(hits(*solid({CutRegion::sphere({3, 3, 3}, 3.0)})), 0u);
    EXPECT_EQ(hits(*solid({CutRegion::sphere(MIDDLE, 8.0)})), 0u);
}

} // namespace CutPickTest
