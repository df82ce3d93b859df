// OSG's intersectors on scenes with volumes.
#include "PickOracle.h"

#include <support/Shapes.h>

#include <osgVolumizer/interact/Probe.h>

#include <osg/ClipNode>
#include <osg/ComputeBoundsVisitor>
#include <osg/MatrixTransform>
#include <osgGA/OrbitManipulator>
#include <osgGA/TrackballManipulator>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/PolytopeIntersector>
#include <osgUtil/RayIntersector>
#include <osgViewer/Viewer>

namespace IntersectorTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using osgUtil::Intersector;
using osgUtil::LineSegmentIntersector;
using osgUtil::PolytopeIntersector;
using osgUtil::RayIntersector;
using support::makeQuad;

namespace {

constexpr int SIZE = 32;
const osg::Vec3d MIDDLE(15.5, 15.5, 15.5);

// An opaque ball of radius 10 in the middle of the voxels.
osg::ref_ptr<VolumeAppearance> ball()
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) {
        return 0.5 + 0.05 * (10.0 - glm::length(p - 15.5));
    });
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setLookupTable(makeTable({{0.5, {1, 1, 1, 0.0}}, {0.5, {1, 1, 1, 1.0}}}));
    return appearance;
}

LineSegmentIntersector::Intersections intersect(osg::Node& node, LineSegmentIntersector* segment)
{
    osg::ref_ptr<LineSegmentIntersector> held(segment);
    osgUtil::IntersectionVisitor visitor(segment);
    node.accept(visitor);
    return segment->getIntersections();
}

void expectNear(const osg::Vec3d& a, const osg::Vec3d& b, double tolerance)
{
    EXPECT_LT((a - b).length(), tolerance) << a.x() << " " << a.y() << " " << a.z() << ", expected "
                                           << b.x() << " " << b.y() << " " << b.z();
}

osg::ref_ptr<osg::MatrixTransform> below(const osg::Matrixd& matrix, osg::Node* node)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->addChild(node);
    return transform;
}

osg::ref_ptr<osg::Camera> cameraOver(osg::Node* scene)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(0, 0, 200, 100);
    camera->setViewMatrixAsLookAt(MIDDLE + osg::Vec3d(0, -100, 0), MIDDLE, {0, 0, 1});
    camera->setProjectionMatrixAsPerspective(30.0, 2.0, 10.0, 500.0);
    camera->addChild(scene);
    return camera;
}

// Trilinear values bulge a little inside the ball's radius.
constexpr double NEAR = 0.1;

TEST(Intersectors, FillInAnIntersection)
{
    const auto volume = ball();
    const auto hits =
        intersect(*volume, new LineSegmentIntersector(MIDDLE - osg::Vec3d(0, 100, 0),
                                                      MIDDLE + osg::Vec3d(0, 100, 0)));
    ASSERT_EQ(hits.size(), 1u);
    const auto& hit = *hits.begin();
    expectNear(hit.localIntersectionPoint, {15.5, 5.5, 15.5}, NEAR);
    EXPECT_NEAR(hit.ratio, 90.0 / 200.0, NEAR / 200.0);
    expectNear(hit.localIntersectionNormal, {0, -1, 0}, 0.01);
    EXPECT_EQ(hit.drawable.get(), volume->getChild(0));
    ASSERT_EQ(hit.nodePath.size(), 2u);
    EXPECT_EQ(hit.nodePath[1], volume->getChild(0));
    EXPECT_LT(hit.primitiveIndex, 5u);
}

TEST(Intersectors, SeeThroughTransforms)
{
    const osg::Matrixd matrices[] = {
        osg::Matrixd::rotate(0.7, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(5, -3, 8),
        osg::Matrixd::scale(1e-6, 1e-6, 1e-6), osg::Matrixd::translate(6.4e6, -6.4e6, 6.4e6),
        osg::Matrixd::scale(2.0, 0.5, -1.0) * osg::Matrixd::rotate(1.0, osg::Vec3d(0, 1, 1)),
        osg::Matrixd::scale(1e-6, 1e-6, 1e-6) * osg::Matrixd::translate(6.4e6, 0, 0)};
    for (const osg::Matrixd& m : matrices) {
        const auto root = below(m, ball());
        // OSG's own bounds are floats, in which there is nothing of a millimetre at 6400 km.
        root->setCullingActive(false);
        const osg::Vec3d start = (MIDDLE - osg::Vec3d(0, 100, 0)) * m;
        const osg::Vec3d end = (MIDDLE + osg::Vec3d(0, 100, 0)) * m;
        const auto hits = intersect(*root, new LineSegmentIntersector(start, end));
        ASSERT_EQ(hits.size(), 1u);
        EXPECT_NEAR(hits.begin()->ratio, 0.45, NEAR / 200.0);
        const osg::Vec3d expected = osg::Vec3d(15.5, 5.5, 15.5) * m;
        EXPECT_LT((hits.begin()->getWorldIntersectPoint() - expected).length(),
                  NEAR / 100.0 * (end - start).length());
        osg::Vec3d normal = hits.begin()->getWorldIntersectNormal();
        EXPECT_LT(normal * (end - start), 0.0);
    }
}

TEST(Intersectors, SeeWhatClipNodesLeave)
{
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(2, osg::Vec4d(0, 1, 0, -12))); // y > 12
    clip->addChild(below(osg::Matrixd::translate(0, 3, 0), ball()));
    const osg::Matrixd turned = osg::Matrixd::rotate(0.4, osg::Vec3d(1, 1, 0));
    const auto root = below(turned, clip);
    const auto hits = [&] {
        return intersect(*root,
                         new LineSegmentIntersector((MIDDLE - osg::Vec3d(0, 100, 0)) * turned,
                                                    (MIDDLE + osg::Vec3d(0, 100, 0)) * turned));
    };
    ASSERT_EQ(hits().size(), 1u);
    // In the ball, whose front is cut off.
    expectNear(hits().begin()->localIntersectionPoint, {15.5, 9.0, 15.5}, NEAR);
    const osg::NodePath path = hits().begin()->nodePath;
    ASSERT_EQ(clipPlanesAbove(path).size(), 1u);
    const auto voxels = probe(path, (MIDDLE - osg::Vec3d(0, 100, 0)) * turned,
                              (MIDDLE + osg::Vec3d(0, 100, 0)) * turned);
    ASSERT_TRUE(voxels.ok());
    EXPECT_EQ(voxels->voxels.front().index.y(), 9);
    // Off, it cuts nothing; beyond the volume, everything.
    clip->getOrCreateStateSet()->setMode(GL_CLIP_PLANE2, osg::StateAttribute::OFF);
    expectNear(hits().begin()->localIntersectionPoint, {15.5, 5.5, 15.5}, NEAR);
    clip->getOrCreateStateSet()->setMode(GL_CLIP_PLANE2, osg::StateAttribute::ON);
    clip->getClipPlane(0)->setClipPlane(0, 1, 0, -60);
    EXPECT_TRUE(hits().empty());
}

TEST(Intersectors, WorkInAllFrames)
{
    const auto volume = ball();
    const auto camera = cameraOver(volume);
    const osg::Matrixd view = camera->getViewMatrix(), projection = camera->getProjectionMatrix();
    const osg::Vec3d near(15.5, -80, 15.5), far(15.5, 380, 15.5);
    LineSegmentIntersector* segments[] = {
        new LineSegmentIntersector(Intersector::WINDOW, 100.0, 50.0),
        new LineSegmentIntersector(Intersector::PROJECTION, 0.0, 0.0),
        new LineSegmentIntersector(Intersector::VIEW, near * view, far * view),
        new LineSegmentIntersector(Intersector::MODEL, near, far)};
    for (LineSegmentIntersector* segment : segments) {
        const auto hits = intersect(*camera, segment);
        ASSERT_EQ(hits.size(), 1u);
        expectNear(hits.begin()->getWorldIntersectPoint(), {15.5, 5.5, 15.5}, NEAR);
    }
    camera->setProjectionMatrixAsOrtho(-40, 40, -20, 20, 10.0, 500.0);
    const auto hits = intersect(
        *camera, new LineSegmentIntersector(Intersector::WINDOW, 100.0 + 2.5 * 6.0, 50.0));
    ASSERT_EQ(hits.size(), 1u);
    expectNear(hits.begin()->getWorldIntersectPoint(), {21.5, 7.5, 15.5}, 2 * NEAR);
}

TEST(Intersectors, KeepLimits)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    const auto volume = ball();
    scene->addChild(volume);
    scene->addChild(below(osg::Matrixd::translate(0, 40, 0), volume));
    const auto segment = [&](Intersector::IntersectionLimit limit) {
        auto* made = new LineSegmentIntersector(MIDDLE - osg::Vec3d(0, 100, 0),
                                                MIDDLE + osg::Vec3d(0, 100, 0));
        made->setIntersectionLimit(limit);
        return made;
    };
    EXPECT_EQ(intersect(*scene, segment(Intersector::NO_LIMIT)).size(), 2u);
    EXPECT_EQ(intersect(*scene, segment(Intersector::LIMIT_ONE)).size(), 1u);
    EXPECT_EQ(intersect(*scene, segment(Intersector::LIMIT_ONE_PER_DRAWABLE)).size(), 2u);
    for (int order = 0; order < 2; ++order) {
        const auto nearest = intersect(*scene, segment(Intersector::LIMIT_NEAREST));
        ASSERT_EQ(nearest.size(), 1u);
        EXPECT_NEAR(nearest.begin()->ratio, 0.45, 0.001);
        const osg::ref_ptr<osg::Node> first = scene->getChild(0);
        scene->removeChild(0, 1);
        scene->addChild(first);
    }
}

TEST(Intersectors, LetSurfacesInFrontWin)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    const auto volume = ball();
    scene->addChild(volume);
    scene->addChild(
        makeQuad({osg::Vec3(0, 3, 0), {15, 3, 0}, {15, 3, 31}, {0, 3, 31}}, {1, 1, 1, 0.2f}, true));
    const auto camera = cameraOver(scene);
    const auto behind = zpick(*camera, 95, 50), beside = zpick(*camera, 105, 50);
    ASSERT_TRUE(behind.ok() && behind->has_value() && beside.ok() && beside->has_value());
    EXPECT_FALSE((*behind)->isVolume);
    EXPECT_NEAR((*behind)->point.y(), 3.0, 1e-4);
    EXPECT_TRUE((*beside)->isVolume);
    EXPECT_NEAR((*beside)->point.y(), 5.9, 0.6);
    EXPECT_EQ((*beside)->nodePath.back(), volume->getChild(0));
    EXPECT_EQ(geometryOf((*beside)->nodePath), volume->getChild(0));
    EXPECT_EQ(appearanceOf((*beside)->nodePath), volume.get());
    EXPECT_FALSE(zpick(*camera, 1, 1)->has_value());
    EXPECT_FALSE(zpick(*camera, 105, 50, 0)->has_value());
}

TEST(Intersectors, RefuseCamerasWithoutAView)
{
    const auto camera = cameraOver(ball());
    EXPECT_EQ(zpick(*camera, std::nan(""), 1).status.code, ErrorCode::VALUE_INVALID);
    camera->setProjectionMatrix(osg::Matrixd::scale(0, 0, 0));
    EXPECT_EQ(zpick(*camera, 1, 1).status.code, ErrorCode::SINGULAR_MATRIX);
    camera->setViewport(static_cast<osg::Viewport*>(nullptr));
    EXPECT_EQ(zpick(*camera, 1, 1).status.code, ErrorCode::VALUE_INVALID);
}

TEST(Intersectors, WorkInGroups)
{
    osg::ref_ptr<osgUtil::IntersectorGroup> group = new osgUtil::IntersectorGroup;
    osg::ref_ptr<LineSegmentIntersector> hitting =
        new LineSegmentIntersector(MIDDLE - osg::Vec3d(0, 100, 0), MIDDLE + osg::Vec3d(0, 100, 0));
    osg::ref_ptr<LineSegmentIntersector> missing =
        new LineSegmentIntersector(osg::Vec3d(1, -100, 1), osg::Vec3d(1, 100, 1));
    osg::ref_ptr<RayIntersector> ray =
        new RayIntersector(MIDDLE - osg::Vec3d(0, 100, 0), osg::Vec3d(0, 2, 0));
    group->addIntersector(hitting);
    group->addIntersector(missing);
    group->addIntersector(ray);
    osgUtil::IntersectionVisitor visitor(group);
    below(osg::Matrixd::translate(0, 3, 0), ball())->accept(visitor);
    EXPECT_EQ(hitting->getIntersections().size(), 1u);
    EXPECT_TRUE(missing->getIntersections().empty());
    ASSERT_EQ(ray->getIntersections().size(), 1u);
    EXPECT_NEAR(ray->getFirstIntersection().distance, 93.0, NEAR);
    expectNear(ray->getFirstIntersection().getWorldIntersectPoint(), {15.5, 8.5, 15.5}, NEAR);
}

TEST(Intersectors, PolytopesFindWhatShows)
{
    const auto camera = cameraOver(ball());
    const auto find = [&](double x0, double y0, double x1, double y1) {
        osg::ref_ptr<PolytopeIntersector> polytope =
            new PolytopeIntersector(Intersector::WINDOW, x0, y0, x1, y1);
        osgUtil::IntersectionVisitor visitor(polytope);
        camera->accept(visitor);
        return polytope->getIntersections();
    };
    const auto middle = find(99, 49, 101, 51);
    ASSERT_EQ(middle.size(), 1u);
    expectNear(middle.begin()->localIntersectionPoint, {15.5, 5.5, 15.5}, 1.0);
    EXPECT_GT(middle.begin()->numIntersectionPoints, 3u);
    EXPECT_NEAR(middle.begin()->distance, 100 - 10 - 10.0, 1.5); // from the near plane
    EXPECT_EQ(find(99.99, 49.99, 100.01, 50.01).size(), 1u);     // less than a voxel
    EXPECT_EQ(find(0, 0, 200, 100).size(), 1u);
    // In the box of the volume, but beside the ball.
    EXPECT_TRUE(find(100 + 26, 50 + 24, 100 + 27, 50 + 25).empty());
    EXPECT_TRUE(find(1, 1, 5, 5).empty());
}

TEST(Intersectors, PolytopesFindDeformedAndColouredMeshes)
{
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->addChild(VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 8, 8, 8)));
    osg::Polytope planes;
    planes.add(osg::Plane(1, 0, 0, -3.0)); // x >= 3
    planes.add(osg::Plane(0, 0, 1, 10.0)); // z >= -10
    osg::ref_ptr<PolytopeIntersector> polytope =
        new PolytopeIntersector(Intersector::MODEL, planes);
    osgUtil::IntersectionVisitor visitor(polytope);
    appearance->accept(visitor);
    ASSERT_EQ(polytope->getIntersections().size(), 1u);
    EXPECT_GE(polytope->getFirstIntersection().localIntersectionPoint.x(), 3.0);
}

TEST(Intersectors, FindNothingWhereNothingIsDrawn)
{
    const osg::ref_ptr<VolumeGeometry> alone =
        VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 31, 31, 31));
    const auto line = [] {
        return new LineSegmentIntersector(osg::Vec3d(9, 9, -9), osg::Vec3d(9, 9, 90));
    };
    EXPECT_TRUE(intersect(*alone, line()).empty()); // no appearance
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setVoxels(new Voxels);
    appearance->addChild(alone);
    EXPECT_TRUE(intersect(*appearance, line()).empty());
    appearance->addChild(new VolumeGeometry);
    EXPECT_TRUE(intersect(*appearance, line()).empty());
    const auto shown = ball();
    const osg::Vec3d nan(std::nan(""), 0, 0);
    EXPECT_TRUE(intersect(*shown, new LineSegmentIntersector(MIDDLE, MIDDLE)).empty());
    EXPECT_TRUE(intersect(*shown, new LineSegmentIntersector(nan, MIDDLE)).empty());
    osg::ref_ptr<RayIntersector> ray = new RayIntersector(MIDDLE, osg::Vec3d());
    osgUtil::IntersectionVisitor visitor(ray);
    shown->accept(visitor);
    EXPECT_TRUE(ray->getIntersections().empty());
}

TEST(Intersectors, LeaveBoundsAlone)
{
    const auto root = below(osg::Matrixd::translate(1, 2, 3), ball());
    osg::ComputeBoundsVisitor visitor;
    root->accept(visitor);
    const osg::BoundingBox box = visitor.getBoundingBox();
    EXPECT_NEAR(box.xMin(), 1.0, 1e-4);
    EXPECT_NEAR(box.zMax(), 34.0, 1e-4);
}

/// What a key or a click does is protected.
template <class Manipulator>
struct Centred : Manipulator
{
    bool centreAt(const osgGA::GUIEventAdapter& event, osgViewer::View& view)
    {
        return this->setCenterByMousePointerIntersection(event, view);
    }
};

template <class Manipulator>
void expectCentre()
{
    osgViewer::Viewer viewer;
    osg::ref_ptr<Centred<Manipulator>> manipulator = new Centred<Manipulator>;
    osg::Camera& camera = *viewer.getCamera();
    viewer.setSceneData(ball());
    camera.setViewport(0, 0, 200, 100);
    camera.setProjectionMatrixAsPerspective(30.0, 2.0, 10.0, 500.0);
    manipulator->setTransformation(MIDDLE - osg::Vec3d(0, 100, 0), MIDDLE, osg::Vec3d(0, 0, 1));
    camera.setViewMatrix(manipulator->getInverseMatrix());
    osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
    event->setInputRange(0, 0, 200, 100);
    event->setX(100);
    event->setY(50);
    EXPECT_TRUE(manipulator->centreAt(*event, viewer));
    expectNear(manipulator->getCenter(), {15.5, 5.5, 15.5}, 2 * NEAR);
}

TEST(Intersectors, CentreManipulators)
{
    expectCentre<osgGA::TrackballManipulator>();
    expectCentre<osgGA::OrbitManipulator>();
}

} // namespace

} // namespace IntersectorTest
