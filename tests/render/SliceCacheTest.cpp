// Slices of an earlier frame are drawn again as long as they are right, or nearly so where that is
// allowed.

#include "Volumes.h"

#include <support/GLTest.h>

#include <osg/MatrixTransform>

namespace SliceCacheTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

class SliceCache : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(17), bumps);
        ASSERT_TRUE(voxels->setBrickSize({9, 9, 9}));
        _volume = makeVolume(voxels);
        _volume->setTechnique(VolumeAppearance::SLICES);
        _volume->setLookupTable(makeTable(smoothPoints(0.1)));
        _geometry = dynamic_cast<VolumeGeometry*>(_volume->getChild(0));
    }

    // A picture from a direction that is turned by an angle about the volume's middle, and how
    // often something was polygonized for it.
    struct Frame
    {
        FloatImage image;
        double polygonizations;
    };
    static RenderOptions viewAt(double angle, double distance = 50.0)
    {
        return RenderOptions().size(64, 64).perspective(35.0).lookAt(
            {8 + distance * std::sin(angle), 8 - distance * std::cos(angle), 14}, {8, 8, 8},
            {0, 0, 1});
    }
    static Frame frame(support::SceneRenderer& renderer)
    {
        FloatImage image = renderer.render();
        return {std::move(image), renderer.counters().at("osgVolumizer polygonizations")};
    }
    static Frame frame(support::SceneRenderer& renderer, double angle)
    {
        renderer.options() = viewAt(angle);
        return frame(renderer);
    }
    // The picture of a renderer that has no earlier frames.
    FloatImage freshPicture(double angle) const
    {
        osg::ref_ptr<VolumeAppearance> volume = new VolumeAppearance(*_volume);
        volume->removeChildren(0, volume->getNumChildren());
        osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry(*_geometry);
        geometry->setSlackAngle(0.0);
        volume->addChild(geometry);
        return support::renderScene(volume, viewAt(angle));
    }

    osg::ref_ptr<VolumeAppearance> _volume;
    VolumeGeometry* _geometry = nullptr;
};

TEST_F(SliceCache, UnchangedViewsPolygonizeNothing)
{
    support::SceneRenderer renderer(_volume, viewAt(0.0));
    const Frame first = frame(renderer);
    EXPECT_EQ(first.polygonizations, 1);
    EXPECT_GT(support::coveredPixels(first.image).count(), 100u);
    for (int i = 0; i < 3; ++i) {
        const Frame again = frame(renderer);
        EXPECT_EQ(again.polygonizations, 0);
        EXPECT_EQ(support::compare(again.image, first.image).maximum, 0.0);
    }
    EXPECT_GT(renderer.counters().at("osgVolumizer faces"), 16);

    // A table is no matter of faces; a period is.
    _volume->setLookupTable(makeTable(smoothPoints(0.3)));
    EXPECT_EQ(frame(renderer).polygonizations, 0);
    _volume->setSamplingPeriod(osg::Vec3d(0.5, 0.5, 0.5));
    EXPECT_EQ(frame(renderer).polygonizations, 1);
    EXPECT_EQ(frame(renderer).polygonizations, 0);
}

TEST_F(SliceCache, ChangedViewsAndGeometryAreSeen)
{
    support::SceneRenderer renderer(_volume, viewAt(0.0));
    frame(renderer);
    const Frame turned = frame(renderer, 0.1);
    EXPECT_EQ(turned.polygonizations, 1);
    EXPECT_LE(support::compare(turned.image, freshPicture(0.1)).maximum, 1e-6);

    core::TetraSet half = *_geometry->getTetraSet();
    for (std::size_t i = 0; i < half.vertices.size(); ++i)
        half.vertices.setPosition(i, 0.5 * half.vertices.position(i));
    ASSERT_TRUE(_geometry->setTetraSet(half));
    const Frame changed = frame(renderer);
    EXPECT_EQ(changed.polygonizations, 1);
    EXPECT_GT(support::compare(changed.image, turned.image).maximum, 1e-2);
    EXPECT_LE(support::compare(changed.image, freshPicture(0.1)).maximum, 1e-6);
}

TEST_F(SliceCache, PlacesInTheGraphHaveSlicesOfTheirOwn)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (double x : {-12.0, 12.0}) {
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
        place->setMatrix(osg::Matrix::rotate(0.3 * x, 0, 0, 1) * osg::Matrix::translate(x, 0, 0));
        place->addChild(_volume);
        scene->addChild(place);
    }
    support::SceneRenderer renderer(scene, viewAt(0.0, 90.0));
    EXPECT_EQ(frame(renderer).polygonizations, 2);
    EXPECT_EQ(frame(renderer).polygonizations, 0);
}

TEST_F(SliceCache, SlackIsKeptWithinItsAngle)
{
    ASSERT_TRUE(_geometry->setSlackAngle(0.05));
    support::SceneRenderer renderer(_volume, viewAt(0.0));
    EXPECT_EQ(frame(renderer).polygonizations, 1);
    const Frame within = frame(renderer, 0.04);
    EXPECT_EQ(within.polygonizations, 0);
    EXPECT_GT(support::compare(within.image, freshPicture(0.04)).maximum, 0.0);
    EXPECT_EQ(frame(renderer, 0.06).polygonizations, 1);

    EXPECT_FALSE(_geometry->setSlackAngle(-1.0));
    EXPECT_FALSE(_geometry->setSlackAngle(std::nan("")));
    EXPECT_EQ(_geometry->getSlackAngle(), 0.05);
}

TEST_F(SliceCache, PlanesOfAnOlderViewSampleAsWellAsOthers)
{
    // Opacity is counted along the normal that they have, so both pictures have the same limit.
    // With that of the new view the difference would stay at a few hundredths.
    ASSERT_TRUE(_geometry->setSlackAngle(0.5));
    std::vector<double> steps, errors;
    for (const double period : {1.0, 0.5, 0.25, 0.125}) {
        _volume->setSamplingPeriod(osg::Vec3d(period, period, period));
        support::SceneRenderer renderer(_volume, viewAt(0.0));
        frame(renderer);
        const Frame turned = frame(renderer, 0.45);
        EXPECT_EQ(turned.polygonizations, 0);
        steps.push_back(period);
        errors.push_back(support::compare(turned.image, freshPicture(0.45)).rmse);
    }
    EXPECT_LE(errors.back(), 4e-3);
    EXPECT_GE(support::convergenceOrder(steps, errors), 0.8);
}

TEST_F(SliceCache, SlackDoesNotTouchWhatIsMerged)
{
    osg::ref_ptr<VolumeAppearance> other = new VolumeAppearance(*_volume);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(_volume);
    scene->addChild(other);
    ASSERT_TRUE(_geometry->setSlackAngle(0.05));
    support::SceneRenderer renderer(scene, viewAt(0.0));
    EXPECT_EQ(frame(renderer).polygonizations, 2);
    EXPECT_EQ(frame(renderer).polygonizations, 0);
    EXPECT_EQ(frame(renderer, 0.01).polygonizations, 2);
}

} // namespace

} // namespace SliceCacheTest
