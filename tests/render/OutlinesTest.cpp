// What a PolygonMode of lines shows of volumes: the edges of tetrahedra and bricks.

#include "PagedScene.h"

#include <osgVolumizer/Outlines.h>

#include <osg/MatrixTransform>
#include <osg/PolygonMode>

#include <support/GLTest.h>

namespace OutlinesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

class Outlines : public support::GLTest
{
};

RenderOptions view(const osg::Vec3d& origin = {0, 0, 0})
{
    return RenderOptions().size(120, 120).perspective(35.0).lookAt(
        origin + osg::Vec3d(55, -40, 45), origin + osg::Vec3d(12, 12, 12), {0, 0, 1});
}

osg::ref_ptr<VolumeAppearance> wireframe(const osg::Vec3d& origin = {0, 0, 0})
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(25), bumps);
    EXPECT_TRUE(voxels->setBrickSize({13, 25, 25}));
    EXPECT_TRUE(voxels->setOrigin(origin));
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->getOrCreateStateSet()->setAttribute(
        new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE));
    return volume;
}

// The same lines as nodes of the scene.
osg::ref_ptr<osg::Node> lines(const VolumeAppearance& volume)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(createTetraOutlines(*dynamic_cast<const VolumeGeometry*>(volume.getChild(0))));
    group->addChild(createBrickOutlines(*volume.getVoxels()));
    return group;
}

} // namespace

TEST_F(Outlines, ArePolygonModesOfVolumes)
{
    for (const osg::Vec3d& origin : {osg::Vec3d(0, 0, 0), {6.4e6, -3.2e6, 1.6e6}}) {
        const osg::ref_ptr<VolumeAppearance> volume = wireframe(origin);
        const FloatImage shown = support::renderScene(volume, view(origin));
        support::savePicture(shown, "wireframe");
        const std::size_t count = support::coveredPixels(shown).count();
        EXPECT_GT(count, 500u);
        EXPECT_LT(count, 5000u); // of 14400
        // The same as the drawing aids where the volume is.
        volume->getStateSet()->clear();
        const FloatImage aids = support::renderScene(lines(*volume), view(origin));
        EXPECT_LT(support::compare(shown, aids).rmse, origin.x() == 0.0 ? 1e-6 : 0.2);
        EXPECT_GT(support::coveredPixels(aids).count(), 500u);
        // Filled it is the volume again.
        EXPECT_GT(support::coveredPixels(support::renderScene(volume, view(origin))).count(),
                  5000u);
    }
}

TEST_F(Outlines, OfPagedVoxelsAreThoseOfTheCoarsestLevel)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(25), bumps);
    ASSERT_TRUE(voxels->setBrickSize({9, 9, 9}));
    EXPECT_EQ(brickOutlines(*voxels).size(), 27u);
    EXPECT_TRUE(brickOutlines(*osg::ref_ptr<Voxels>(new Voxels)).empty());
    const osg::ref_ptr<Voxels> paged =
        new Voxels(new paged::FormulaSource(40, [](const glm::dvec3&) { return 0.5; }));
    ASSERT_TRUE(paged->isPaged());
    core::Box3d all;
    for (const core::Box3d& box : brickOutlines(*paged)) {
        all.expand(box.min);
        all.expand(box.max);
    }
    EXPECT_EQ(all, paged->getLayout().extent());
    EXPECT_LE(brickOutlines(*paged).size(), 8u);
}

} // namespace OutlinesTest
