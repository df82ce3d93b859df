// osg::ClipPlanes cut volumes as they cut geometry.

#include "MixedScene.h"
#include "Volumes.h"

#include <osg/ClipNode>
#include <osg/MatrixTransform>

#include <support/GLTest.h>
#include <support/Precision.h>

namespace ClipPlanesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 25;
const osg::BoundingBoxd PART(5.3, 4.2, 6.9, 19.6, 21.1, 17.4);

RenderOptions view(const osg::Vec3d& eye = {55, -40, 45})
{
    return RenderOptions().size(90, 80).perspective(35.0).lookAt(eye, {12, 12, 12}, {0, 0, 1});
}

// The six planes of a box, which leave its inside.
osg::ref_ptr<osg::ClipNode> clipTo(const osg::BoundingBoxd& box)
{
    osg::ref_ptr<osg::ClipNode> node = new osg::ClipNode;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool low : {true, false}) {
            osg::Vec4d plane(0, 0, 0, low ? -box._min[axis] : box._max[axis]);
            plane[axis] = low ? 1.0 : -1.0;
            node->addClipPlane(new osg::ClipPlane(unsigned(2 * axis + low), plane));
        }
    return node;
}

osg::ref_ptr<A> volumeOf(A::Technique technique, double opacity = 0.15)
{
    static const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const osg::ref_ptr<A> volume = makeVolume(voxels);
    volume->setTechnique(technique);
    volume->setLookupTable(makeTable(smoothPoints(opacity)));
    volume->setSamplingPeriod({0.25, 0.25, 0.25});
    support::filterExactly(*volume);
    return volume;
}

// The same, of which the geometry is a part.
osg::ref_ptr<A> cutOut(A* volume, const osg::BoundingBoxd& box)
{
    volume->removeChildren(0, volume->getNumChildren());
    volume->addChild(VolumeGeometry::createBox(box));
    return volume;
}

osg::ref_ptr<osg::Group> groupOf(std::initializer_list<osg::ref_ptr<osg::Node>> nodes)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (const auto& node : nodes)
        group->addChild(node);
    return group;
}

osg::ref_ptr<osg::ClipNode> under(const osg::ref_ptr<osg::ClipNode>& clip, osg::Node* node)
{
    clip->addChild(node);
    return clip;
}

double difference(const FloatImage& a, const FloatImage& b)
{
    return support::compare(a, b, support::coveredPixels(a) | support::coveredPixels(b)).maximum;
}

class ClipPlanes : public support::GLTest
{
};

} // namespace

TEST_F(ClipPlanes, SixCutAsABoxOfGeometryDoes)
{
    for (const osg::Vec3d& eye : {osg::Vec3d(55, -40, 45), {12, 60, 12}, {12, 11, 10}}) {
        const FloatImage cut =
            support::renderScene(under(clipTo(PART), volumeOf(A::SLABS)), view(eye));
        const FloatImage expected =
            support::renderScene(cutOut(volumeOf(A::SLABS), PART), view(eye));
        EXPECT_GT(support::coveredPixels(expected, 0.2f).count(), 500u);
        // From within, rays begin at the near plane, which is nearer to the smaller of two boxes.
        const bool within = eye.z() == 10.0;
        EXPECT_LT(difference(cut, expected), within ? 1e-3 : 1e-5) << eye.x() << " " << eye.y();
        support::savePicture(cut, "clipped_slabs");
    }
}

// Slices lie at fractions of the geometry's depth, which is the same for both along an axis.
TEST_F(ClipPlanes, SlicesAreCutAsABoxOfGeometryIs)
{
    osg::BoundingBoxd part = PART;
    part.yMin() = 0.0;
    part.yMax() = SIZE - 1.0;
    RenderOptions along = view({12, -60, 12});
    along.orthographic(30.0);
    const FloatImage cut = support::renderScene(under(clipTo(part), volumeOf(A::SLICES)), along);
    const FloatImage expected = support::renderScene(cutOut(volumeOf(A::SLICES), part), along);
    EXPECT_GT(support::coveredPixels(expected, 0.2f).count(), 200u);
    EXPECT_LT(difference(cut, expected), 1e-5);
    // From elsewhere they agree as far as slices are exact.
    const FloatImage elsewhere =
        support::renderScene(under(clipTo(PART), volumeOf(A::SLICES)), view());
    EXPECT_LT(
        compare(elsewhere, support::renderScene(cutOut(volumeOf(A::SLICES), PART), view())).rmse,
        1e-2);
    support::savePicture(elsewhere, "clipped_slices");
}

// A plane has its place where its node is, and cuts at an angle.
TEST_F(ClipPlanes, LieWhereTheirNodesAre)
{
    osg::ref_ptr<osg::MatrixTransform> turned = new osg::MatrixTransform;
    turned->setMatrix(osg::Matrixd::rotate(0.5, osg::Vec3d(1, 2, 0.5)) *
                      osg::Matrixd::translate(12, 12, 12) * osg::Matrixd::scale(2, 2, 2) *
                      osg::Matrixd::translate(-12, -12, -12));
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(3, osg::Vec4d(0.0, 0.0, 1.0, 0.5)));
    osg::ref_ptr<osg::MatrixTransform> back = new osg::MatrixTransform;
    back->setMatrix(osg::Matrixd::inverse(turned->getMatrix()));
    back->addChild(volumeOf(A::SLABS));
    clip->addChild(back);
    turned->addChild(clip);
    const FloatImage cut = support::renderScene(turned, view());
    // The same as tetrahedra that end at the plane.
    const osg::Vec4d plane = osg::Plane(0.0, 0.0, 1.0, 0.5).asVec4();
    osg::Matrixd m = osg::Matrixd::inverse(turned->getMatrix());
    osg::Vec4d world;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            world[i] += m(i, j) * plane[j];
    osg::ref_ptr<osg::ClipNode> same = new osg::ClipNode;
    same->addClipPlane(new osg::ClipPlane(0, world));
    EXPECT_LT(difference(cut, support::renderScene(under(same, volumeOf(A::SLABS)), view())), 1e-5);
    const FloatImage whole = support::renderScene(volumeOf(A::SLABS), view());
    EXPECT_GT(difference(cut, whole), 0.1);
    // What one half shows and the other composite to the whole where the plane faces the eye.
    EXPECT_GT(support::coveredPixels(cut).count(), 300u);
    EXPECT_LT(support::coveredPixels(cut).count(), support::coveredPixels(whole).count());
}

TEST_F(ClipPlanes, OnlyThoseThatAreOnCut)
{
    const FloatImage whole = support::renderScene(volumeOf(A::SLABS), view());
    osg::ref_ptr<osg::ClipNode> off = clipTo(PART);
    off->setStateSetModes(*off->getOrCreateStateSet(), osg::StateAttribute::OFF);
    off->addChild(volumeOf(A::SLABS));
    EXPECT_EQ(difference(support::renderScene(off, view()), whole), 0.0);
    // A mode without a plane.
    osg::ref_ptr<A> none = volumeOf(A::SLABS);
    none->getOrCreateStateSet()->setMode(GL_CLIP_PLANE0 + 1, osg::StateAttribute::ON);
    EXPECT_EQ(difference(support::renderScene(none, view()), whole), 0.0);
    // A plane beyond everything leaves nothing.
    osg::ref_ptr<osg::ClipNode> all = new osg::ClipNode;
    all->addClipPlane(new osg::ClipPlane(0, osg::Vec4d(1, 0, 0, -100)));
    const FloatImage nothing = support::renderScene(under(all, volumeOf(A::SLABS)), view());
    EXPECT_EQ(support::coveredPixels(nothing).count(), 0u);
    // Of a state set: in the frame of what it stands above.
    osg::ref_ptr<A> own = volumeOf(A::SLABS);
    own->getOrCreateStateSet()->setAttributeAndModes(
        new osg::ClipPlane(2, osg::Vec4d(-1, 0, 0, 12.5)));
    const FloatImage half =
        support::renderScene(cutOut(volumeOf(A::SLABS), {0, 0, 0, 12.5, 24, 24}), view());
    EXPECT_LT(difference(support::renderScene(own, view()), half), 1e-5);
    // That is where its vertices are, whatever the spacing of its voxels.
    const osg::ref_ptr<A> spaced = makeVolume(makeVoxels(glm::ivec3(49), bumps));
    ASSERT_TRUE(spaced->getVoxels()->setSpacing({0.5, 0.5, 0.5}));
    spaced->setLookupTable(volumeOf(A::SLABS)->getLookupTable());
    support::filterExactly(*spaced);
    const auto cutAt = [&](osg::StateSet* set, const osg::BoundingBoxd& box) {
        cutOut(spaced, box);
        spaced->setStateSet(set);
        // So near that a pixel is smaller than a voxel, or periods would count in pixels at the
        // nearest corner, which is another one.
        return support::renderScene(spaced, view().perspective(15.0));
    };
    const osg::BoundingBoxd all24(0, 0, 0, 24, 24, 24), left(0, 0, 0, 12.5, 24, 24);
    EXPECT_LT(difference(cutAt(own->getStateSet(), all24), cutAt(nullptr, left)), 1e-5);
}

// Two volumes in one place, each with a half of its own.
TEST_F(ClipPlanes, OverlappingVolumesHaveEachTheirOwn)
{
    const auto half = [](unsigned number, double sign) {
        osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
        clip->addClipPlane(new osg::ClipPlane(number, osg::Vec4d(sign, 0, 0, -12.3 * sign)));
        return clip;
    };
    for (const unsigned second : {0u, 1u}) {
        // OpenGL has one plane of a number: the last one counts for all.
        const auto scene = groupOf({under(half(0, 1.0), volumeOf(A::SLABS)),
                                    under(half(1, second ? -1.0 : 1.0), volumeOf(A::SLABS, 0.3))});
        const osg::BoundingBoxd low(0, 0, 0, 12.3, 24, 24), high(12.3, 0, 0, 24, 24, 24);
        const auto expected = groupOf({cutOut(volumeOf(A::SLABS), high),
                                       cutOut(volumeOf(A::SLABS, 0.3), second ? low : high)});
        const FloatImage picture = support::renderScene(scene, view());
        EXPECT_GT(support::coveredPixels(picture, 0.2f).count(), 500u);
        EXPECT_LT(difference(picture, support::renderScene(expected, view())),
                  second ? 1e-5 : 1e-4);
        support::savePicture(picture, "clipped_overlapping");
    }
}

// A sheet of glass within, which the planes cut too or not.
TEST_F(ClipPlanes, SurfacesInsideKeepTheirPlaces)
{
    const auto glass = [] {
        return makeGeometry(
            quadMesh({glm::vec3(-4, 10, -4), {30, 14, -4}, {30, 14, 30}, {-4, 10, 30}}),
            {0.2, 0.5, 0.9, 0.5}, false);
    };
    const osg::ref_ptr<osg::ClipNode> clip = clipTo(PART);
    clip->addChild(volumeOf(A::SLABS));
    const FloatImage picture = support::renderScene(groupOf({clip, glass()}), view());
    const FloatImage expected =
        support::renderScene(groupOf({cutOut(volumeOf(A::SLABS), PART), glass()}), view());
    EXPECT_LT(difference(picture, expected), 1e-5);
    clip->addChild(glass());
    const FloatImage both = support::renderScene(clip, view());
    EXPECT_GT(difference(both, picture), 0.1);
    support::savePicture(both, "clipped_with_glass");
}

// Bricks that are cut away are not drawn.
TEST_F(ClipPlanes, WhatIsCutAwayIsNotMarched)
{
    const osg::ref_ptr<A> volume = volumeOf(A::SLABS);
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    ASSERT_TRUE(voxels->setBrickSize({7, 7, 7}));
    volume->setVoxels(voxels);
    const auto samples = [](osg::Node* scene) {
        support::SceneRenderer renderer(scene, support::joining(view(), false));
        renderer.render();
        return renderer.counters()["osgVolumizer bricks drawn"];
    };
    const double whole = samples(volume);
    const double cut = samples(under(clipTo({0, 0, 0, 5.9, 24, 24}), volume));
    EXPECT_EQ(whole, 64.0);
    EXPECT_EQ(cut, 16.0);
}

TEST_F(ClipPlanes, GatheringRaysAreCutToo)
{
    for (const A::RayFunction function : {A::MAXIMUM, A::AVERAGE, A::ISOSURFACE}) {
        const auto make = [&] {
            const osg::ref_ptr<A> volume = volumeOf(A::SLABS);
            volume->setRayFunction(function);
            volume->setIsoValue(0.5);
            return volume;
        };
        const FloatImage cut = support::renderScene(under(clipTo(PART), make()), view());
        const FloatImage expected = support::renderScene(cutOut(make(), PART), view());
        EXPECT_GT(support::coveredPixels(expected).count(), 200u);
        EXPECT_LT(difference(cut, expected), 1e-4) << function;
    }
}

} // namespace ClipPlanesTest
